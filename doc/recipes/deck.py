# python3 deck.py DECK.inp: the nodes, elements and sets of a plane mesh as statements of a model.
# An element belongs to the smallest ELSET that has it, which is its block and its material.
import sys
import meshio

mesh = meshio.read(sys.argv[1])
sets = sorted(mesh.cell_sets.items(), key=lambda s: sum(len(part) for part in s[1]))
used, number = set(), 0
for k, cells in enumerate(mesh.cells):
    for i, nodes in enumerate(cells.data):
        if cells.type not in ("triangle", "quad"):
            continue
        number += 1
        block = next((name for name, part in sets if i in part[k]), "mesh")
        print("element", number, block, block, *(n + 1 for n in nodes))
        used.update(nodes)
for n in sorted(used):
    print("node", n + 1, *(float(x) for x in mesh.points[n][:2]))
for name, nodes in mesh.point_sets.items():
    print("set", name, "nodes", *(n + 1 for n in nodes if n in used))
