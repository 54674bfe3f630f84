/* check_model.c - the program for model files, from outside: what it says to wrong input, letter by letter, and that it
 * then writes nothing; what it computes, against theory and against other ways to say the same. */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "programs.h"

/* --------------------------------------------------------------------------------------------------- wrong input */

/* tests/bad/NAME.model, and what is said after tests/bad/NAME. */
typedef struct { const char *name, *message; } wrong;

#define NEITHER "neither static nor dynamic, expected one of them, such as: static, or: dynamic dt 1e-3 steps 1000"

static const wrong wrongs[] = {
    { "unknown-statement", ".model:9: there is no statement 'elephant'; the nearest are element, repeat, "
      "expect, and all are in doc/model-file.md" },
    { "blocks-overlap", ".model:11: blocks overlap: 0.005 m deep at (0.5, 0.995): block 'base' with element 1, block "
      "'stone' with element 9" },
    { "unknown-option", ".model:5: unknown option 'colour', expected: material NAME E VALUE nu VALUE density VALUE "
      "[thickness VALUE]" },
    { "unknown-option-fix", ".model:7: unknown option 'z', expected: fix WHERE [of BLOCK] [x [by U]] [y [by V]]" },
    { "missing-word", ".model:3: a word is missing, expected: node ID X Y" },
    { "missing-value", ".model:5: not a number: 'nu', expected: material NAME E VALUE nu VALUE density VALUE "
      "[thickness VALUE]" },
    { "missing-option", ".model:5: density is missing, expected: material NAME E VALUE nu VALUE density VALUE "
      "[thickness VALUE]" },
    { "missing-word-set", ".model:9: a word is missing, expected: set NAME nodes ID ID ..." },
    { "missing-word-where", ".model:9: a word is missing, expected: load WHERE [of BLOCK] FX FY" },
    { "missing-word-element", ".model:6: element 1 has 2 nodes, expected 3 or more" },
    { "surplus-word", ".model:3: surplus word '0', expected: node ID X Y" },
    { "surplus-word-static", ".model:8: unknown option '3', expected: static [steps N] [tolerance VALUE]" },
    { "not-a-number", ".model:3: not a number: 'one', expected: node ID X Y" },
    { "not-a-number-hexadecimal", ".model:3: not a number: '0x1', expected: node ID X Y" },
    { "nan", ".model:3: not a finite number: 'nan', expected: node ID X Y" },
    { "infinite", ".model:3: not a finite number: '1e999', expected: node ID X Y" },
    { "not-whole", ".model:8: not a whole number: '1.5', expected: static [steps N] [tolerance VALUE]" },
    { "count-below-one", ".model:8: steps is 0, expected a whole number, 1 or more" },
    { "count-below-one-every", ".model:9: every is -1, expected a whole number, 1 or more" },
    { "count-below-one-iterations", ".model:9: iterations is 0, expected a whole number, 1 or more" },
    { "count-below-zero", ".model:8: settle is -1, expected a whole number, 0 or more" },
    { "count-too-large", ".model:8: too large: '99999999999', expected: static [steps N] [tolerance VALUE]" },
    { "id-not-whole", ".model:3: an id is a whole number, not '3.5', expected: node ID X Y" },
    { "node-twice", ".model:9: node '1' for the second time, expected a new one" },
    { "node-twice-zeros", ".model:9: node '1' for the second time, expected a new one" },
    { "element-twice", ".model:9: element '1' for the second time, expected a new one" },
    { "material-twice", ".model:9: material 'steel' for the second time, expected a new one" },
    { "set-twice", ".model:10: set 'a' for the second time, expected a new one" },
    { "monitor-twice", ".model:10: monitor 'a' for the second time, expected a new one" },
    { "gravity-twice", ".model:10: gravity for the second time, after line 9, expected it once" },
    { "static-twice", ".model:9: static for the second time, after line 8, expected it once" },
    { "option-twice", ".model:8: steps for the second time, expected: static [steps N] [tolerance VALUE]" },
    { "velocity-twice", ".model:10: a velocity of 'b' for the second time, expected one" },
    { "stress-twice", ".model:10: a stress of 'b' for the second time, expected one" },
    { "fixblock-twice", ".model:10: block 'b' is fixed for the second time, expected once" },
    { "unknown-node", ".model:6: unknown node '5', expected one that the model has, such as 1, 2, 3" },
    { "unknown-node-where", ".model:9: unknown node '7', expected one that the model has, such as 1, 2, 3" },
    { "unknown-material", ".model:6: unknown material 'iron', expected one that the model has, such as steel" },
    { "unknown-block", ".model:9: unknown block 'c', expected one that the model has, such as b" },
    { "unknown-block-velocity", ".model:9: unknown block 'c', expected one that the model has, such as b" },
    { "unknown-set", ".model:9: unknown set 'c', expected one that the model has, such as b" },
    { "unknown-place", ".model:9: unknown place 'right', expected node ID, at X Y, set NAME or box XMIN YMIN XMAX "
      "YMAX in: load WHERE [of BLOCK] FX FY" },
    { "unknown-choice", ".model:9: 'both', expected one of exact|linear" },
    { "unknown-choice-bond", ".model:9: 'corners', expected one of vertices|moment|auto" },
    { "bond-midpoints", ".model:9: 'midpoints', expected one of vertices|moment|auto: bonded in the middles of their "
      "sides alone elements can turn against each other" },
    { "bad-name", ".model:6: not a name (letters, digits, _ - .): 'b,c', expected: element ID BLOCK MATERIAL N1 N2 "
      "N3 [N4 ...]" },
    { "unused-node", ".model:9: no element has node 5, expected one" },
    { "zero-area", ".model:5: element 1 of block 'b' has no area, or one too large, expected a polygon" },
    { "zero-area-node-twice", ".model:4: element 1 of block 'b' has no area, or one too large, expected a polygon" },
    { "self-crossing", ".model:6: the boundary of element 1 of block 'b' meets itself, expected a simple polygon" },
    { "too-large", ".model:6: element 1 of block 'b' has no area, or one too large, expected a polygon" },
    { "overlap", ".model:9: elements of one block overlap: element 1 and element 2 on the same side, from node 1 to "
      "node 2" },
    { "e-zero", ".model:5: E is 0, expected more than 0, from 1e-100 to 1e100" },
    { "e-negative", ".model:5: E is -1, expected more than 0, from 1e-100 to 1e100" },
    { "nu-half", ".model:5: nu is 0.5, expected more than -1 and less than 0.5" },
    { "nu-minus-one", ".model:5: nu is -1, expected more than -1 and less than 0.5" },
    { "density-zero", ".model:5: density is 0, expected more than 0, from 1e-100 to 1e100" },
    { "thickness-zero", ".model:5: thickness is 0, expected more than 0, from 1e-100 to 1e100" },
    { "alpha-zero", ".model:9: alpha is 0, expected more than 0" },
    { "kn-negative", ".model:9: kn is -1, expected 0 or more" },
    { "ks-negative", ".model:9: ks is -1, expected 0 or more" },
    { "friction-ninety", ".model:9: friction is 90, expected 0 to less than 90 degrees" },
    { "friction-negative", ".model:9: friction is -1, expected 0 to less than 90 degrees" },
    { "cohesion-negative", ".model:9: cohesion is -1, expected 0 or more" },
    { "dt-zero", ".model:8: dt is 0, expected more than 0" },
    { "dt-missing", ".model:8: dt is missing, expected: dynamic dt VALUE steps N [velocity_factor VALUE] "
      "[settle N] [ramp T]" },
    { "damping", ".model:8: damping is 1.5, expected 0 to 1" },
    { "velocity-factor", ".model:8: velocity_factor is 1.5, expected 0 to 1" },
    { "velocity-factor-twice", ".model:8: velocity_factor and damping, which are the same, expected one" },
    { "omega-zero", ".model:9: omega is 0, expected more than 0 and less than 2" },
    { "omega-two", ".model:9: omega is 2, expected more than 0 and less than 2" },
    { "tolerance", ".model:9: tolerance is 1, expected more than 0, at most 1e-6" },
    { "tolerance-static", ".model:8: tolerance is 0, expected more than 0" },
    { "where-names-no-node", ".model:9: no node there, the nearest is node 3 at 1 1" },
    { "where-box-empty", ".model:9: no node there, expected a place that names one" },
    { "where-box-reversed", ".model:9: a box from 1, 1 to 0, 0, expected: box XMIN YMIN XMAX YMAX" },
    { "traction-inside", ".model:9: no boundary edge has both ends there, expected one" },
    { "pressure-inside", ".model:10: no boundary edge has both ends there, expected one" },
    { "use-without-mesh", ".model:9: block 'b' has its material in its own statement, expected a block of a mesh" },
    { "no-element", ".model: the model has no element, expected: block ..., grid ..., mesh FILE or element ..." },
    { "empty", ".model: " NEITHER },
    { "static-and-dynamic", ".model:9: static and dynamic, expected one of them" },
    { "neither", ".model: " NEITHER },
    { "free", ".model: block 'b' is free to move, expected fix, fixblock or a contact that holds it in statics" },
    { "free-to-turn", ".model: block 'b' is free to move, expected fix, fixblock or a contact that holds it in "
      "statics" },
    { "free-second-block", ".model: block 'loose' is free to move, expected fix, fixblock or a contact that holds "
      "it in statics; block 'b' is 2 m away" },
    { "near-miss", ".model: block 'b' is free to move, expected fix, fixblock or a contact that holds it in statics; "
      "block 'a' is 0.001 m away" },
    { "minus-sign", ".model:9: not a number: '−9.81', expected: gravity GX GY; it has letters beyond ASCII: minus "
      "is -" },
    { "comment-slashes", ".model:9: surplus word '//', expected: gravity GX GY; a comment begins with #" },
    { "too-small", ".model:9: too small, and not 0: '1e-400', expected: gravity GX GY" },
    { "long-name", ".model:10: a stress of 'bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb' for the second "
      "time, expected one" },
    { "mesh-missing", ".model:9: tests/bad/nowhere.msh cannot be read: No such file or directory" },
    { "mesh-is-a-folder", ".model:9: tests/bad/. cannot be read: Is a directory" },
    { "binary", ".model:2: a zero byte: the file is binary, expected text" },
    { "msh-version", ".msh:2: '2.1' in $MeshFormat, expected version 2.2 or 4.1" },
    { "msh-version-4", ".msh:2: '4' in $MeshFormat, expected version 2.2 or 4.1" },
    { "msh-binary", ".msh:2: the mesh is binary, expected ASCII: gmsh without -bin, or Mesh.Binary = 0" },
    { "msh-lines", ".msh:20: no triangle or quadrilateral, expected a mesh of surfaces: gmsh -2" },
    { "msh-nodes-41", ".msh:25: $Nodes has 4 entries, expected the 5 that it announces" },
    { "msh-elements-41", ".msh:33: $Elements has 3 entries, expected the 4 that it announces" },
    { "msh-empty", ".msh:1: the file ends without $Nodes, expected one" },
    { "msh-no-mesh", ".msh:1: 'This', expected a section like $Nodes" },
    { "msh-no-format", ".msh:1: '$PhysicalNames' in $PhysicalNames, expected $MeshFormat as the first section" },
    { "msh-cut-short", ".msh:19: the file ends inside $Elements, expected $EndElements" },
    { "msh-cut-short-41", ".msh:10: the file ends inside $Entities, expected $EndEntities" },
    { "msh-without-elements", ".msh:16: the file ends without $Elements, expected one" },
    { "msh-count", ".msh:14: '4' in $Nodes, expected the end of the section" },
    { "msh-count-high", ".msh:15: '$EndNodes' in $Nodes, expected a whole number" },
    { "msh-order-two", ".msh:18: element 1 is of type 8, expected 15, 1, 2 or 3: a point, or a line, triangle or "
      "quadrilateral of first order" },
    { "msh-order-two-41", ".msh:31: element 2 is of type 9, expected 15, 1, 2 or 3: a point, or a line, triangle or "
      "quadrilateral of first order" },
    { "msh-volume", ".msh:19: element 2 is of type 4, expected 15, 1, 2 or 3: a point, or a line, triangle or "
      "quadrilateral of first order" },
    { "msh-unknown-node", ".msh:19: '9' in $Elements, expected a node of the mesh" },
    { "msh-node-twice", ".msh:14: node '3' for the second time, expected a new one" },
    { "msh-nan", ".msh:14: 'nan' in $Nodes, expected a finite number" },
    { "msh-no-surface", ".msh:19: element 2 lies in no physical surface, expected one, which is its block" },
    { "msh-no-surface-41", ".msh:31: element 2 lies in no physical surface, expected one, which is its block" },
    { "msh-name", ".msh:6: '\"the' in $PhysicalNames, expected a name in quotes, without blanks" },
    { "msh-zero-area", ".msh:19: element 2 of block 'plate' has no area, or one too large, expected a polygon" },
    { "msh-id-of-the-model", ".model:6: node '1' for the second time, expected a new one" },
    { "msh-no-material", ".model:1: block 'plate' has no material, expected: use MATERIAL on plate" },
    { "msh-use-twice", ".model:6: a material for '*' for the second time, expected one" },
    { "msh-use-unknown", ".model:6: unknown block 'disc', expected one that the model has, such as plate" },
    { "msh-set-twice", ".model:6: set 'left' for the second time, expected a new one" },
    { "msh-set-of-two-kinds", ".model:4: the mesh has several groups of that name, one of surfaces and one of "
      "curves or points, expected one" },
    { "block-crossing", ".model:7: the boundary of element 3 of block 'c' meets itself, expected a simple polygon" },
    { "block-flat", ".model:7: element 3 of block 'c' has no area, or one too large, expected a polygon" },
    { "block-long-id", ".model:6: an id of 18 digits or more, expected at most 17 where blocks are numbered on" },
    { "block-not-a-number", ".model:7: not a number: 'two', expected: block NAME MATERIAL X1 Y1 X2 Y2 X3 Y3 [X4 "
      "Y4 ...]" },
    { "block-odd", ".model:7: block 'c' has 5 coordinates, expected X Y of 3 corners or more" },
    { "block-of-elements", ".model:6: block 'a' for the second time, expected a new one" },
    { "block-overlap", ".model:7: blocks overlap: 0.1 m deep at (1.5, 2): block 'b' with element 2, block 'c' with "
      "element 3" },
    { "block-twice", ".model:7: block 'b' for the second time, expected a new one" },
    { "block-two-corners", ".model:7: block 'c' has 4 coordinates, expected X Y of 3 corners or more" },
    { "block-unknown-material", ".model:7: unknown material 'rokc', expected one that the model has, such as rock" },
    { "expect-by", ".model:8: not the word by: 'within', expected: expect NAME u|v VALUE within TOLERANCE [%], or "
      "expect NAME moves|stays by TOLERANCE" },
    { "expect-kind", ".model:8: 'w', expected one of u|v|moves|stays" },
    { "expect-percent-of-zero", ".model:8: a tolerance in % of 0, expected one in metre" },
    { "expect-short", ".model:8: a word is missing, expected: expect NAME u|v VALUE within TOLERANCE [%], or "
      "expect NAME moves|stays by TOLERANCE" },
    { "expect-surplus", ".model:8: surplus word 'm', expected: expect NAME u|v VALUE within TOLERANCE [%], or "
      "expect NAME moves|stays by TOLERANCE" },
    { "expect-unknown", ".model:8: unknown monitor 'tip', expected one that the model has, such as top" },
    { "expect-within", ".model:8: not the word within: 'by', expected: expect NAME u|v VALUE within TOLERANCE "
      "[%], or expect NAME moves|stays by TOLERANCE" },
    { "expect-zero", ".model:8: a tolerance of 0, expected more than 0" },
    { "fix-by-missing", ".model:7: a word is missing, expected: fix WHERE [of BLOCK] [x [by U]] [y [by V]]" },
    { "fix-by-not-a-number", ".model:7: not a number: 'y', expected: fix WHERE [of BLOCK] [x [by U]] [y [by V]]" },
    { "fix-by-two", ".model:8: node 5 is displaced by 0.2 in x here, by 0.1 in another statement, expected one of "
      "them" },
    { "fix-by-without-direction", ".model:7: unknown option 'by', expected: fix WHERE [of BLOCK] [x [by U]] [y "
      "[by V]]" },
    { "fix-x-twice", ".model:7: x for the second time, expected: fix WHERE [of BLOCK] [x [by U]] [y [by V]]" },
    { "grid-kind", ".model:7: 'hexagons', expected one of quads|triangles|crossed" },
    { "grid-missing", ".model:7: a word is missing, expected: grid NAME MATERIAL X0 Y0 X1 Y1 NX NY "
      "[quads|triangles|crossed]" },
    { "grid-no-cells", ".model:7: NX is 0, expected a whole number, 1 or more" },
    { "grid-reversed", ".model:7: a grid from 1 3 to 0 4, expected X0 < X1 and Y0 < Y1" },
    { "grid-rim-twice", ".model:8: set 'c.left' for the second time, expected a new one" },
    { "grid-surplus", ".model:7: surplus word '3', expected: grid NAME MATERIAL X0 Y0 X1 Y1 NX NY "
      "[quads|triangles|crossed]" },
    { "grid-too-many", ".model:7: a grid of 10000 x 10000 cells, expected at most 4000000" },
    { "contact-restitution", ".model:7: restitution is 1.1, expected 0 to 1" },
    { "joint-cohesion", ".model:7: cohesion is -1, expected 0 or more" },
    { "joint-friction", ".model:7: friction is 90, expected 0 to less than 90 degrees" },
    { "joint-itself", ".model:7: a joint of a block with itself, expected two blocks" },
    { "near-block", ".model:8: unknown set 'bb', expected one that the model has, such as b, a, bottom" },
    { "shake-static", ".model:7: shake in statics, expected dynamic" },
    { "velocity-static", ".model:7: velocity in statics, expected dynamic" },
    { "joint-one-block", ".model:7: a word is missing, expected: joint BLOCK BLOCK [friction DEGREES] [cohesion "
      "PASCAL] [tension PASCAL]" },
    { "joint-option", ".model:7: unknown option 'strength', expected: joint BLOCK BLOCK [friction DEGREES] "
      "[cohesion PASCAL] [tension PASCAL]" },
    { "joint-unknown", ".model:7: unknown block 'c', expected one that the model has, such as a, b" },
    { "let-below", ".model:7: no `let` above says what $b is" },
    { "let-dollar", ".model:7: no `let` says what $ is" },
    { "let-longer-name", ".model:10: no `let` says what $p0 is, expected one such as $p" },
    { "let-out-of-range", ".model:10: friction is 95, from $phi, expected 0 to less than 90 degrees" },
    { "let-missing", ".model:7: a word is missing, expected: let NAME VALUE" },
    { "let-none", ".model:7: no `let` says what $psi is" },
    { "let-not-a-number", ".model:7: not a number: 'thirty', expected: let NAME VALUE" },
    { "let-surplus", ".model:7: surplus word '40', expected: let NAME VALUE" },
    { "let-twice", ".model:8: let 'phi' for the second time, expected a new one" },
    { "let-unknown", ".model:8: no `let` says what $psi is, expected one such as $phi" },
    { "repeat-open", ".model:6: repeat without its `end`, expected: repeat NAME FROM TO, "
      "statements, end" },
    { "repeat-end", ".model:6: end without `repeat`, expected: end" },
    { "repeat-round", ".model:8: j = 1, i = 2: '$(1/(i - 2))' has no value, it is infinite" },
    { "repeat-later", ".model:7: i = 7: unknown material 'rok', expected one that the model "
      "has, such as rock" },
    { "repeat-half", ".model:6: not a whole number: '0.75', from $(t/2), expected: repeat NAME "
      "FROM TO, statements, end" },
    { "repeat-endless", ".model:9: i = 1, j = 999, k = 3: repetitions make more than 1000000 "
      "statements, expected fewer" },
    { "repeat-long", ".model:8: i = 223: the values of numbers take more than 67108864 bytes, "
      "expected less" },
    { "repeat-deep", ".model:26: i0 = 1, i1 = 1, i2 = 1, i3 = 1, i4 = 1, i5 = 1, i6 = 1, i7 = "
      "1, i8 = 1, i9 = 1, i10 = 1, i11 = 1, i1: more than 20 times repeat in repeat, expected fewer" },
    { "repeat-let", ".model:7: i = 1: let 't' for the second time, expected a new one" },
    { "repeat-counter", ".model:7: i = 1: 'i' for the second time in one round, expected a new "
      "name" },
    { "repeat-twice", ".model:7: i = 2: gravity for the second time, after line 7, expected it "
      "once" },
    { "number-glued", ".model:6: '2$t' would be '21.5'; a number is one piece, as 5, $p, -$p or $(2*p)" },
    { "number-longer", ".model:6: no `let` says what $t0 is, expected one such as $t" },
    { "number-open", ".model:6: an operator or ) is missing at '0' in '$(sin(30) 0'" },
    { "number-function", ".model:6: no function is called so (there are sqrt sin cos tan asin "
      "acos atan abs floor min max), or a * is missing, at 'sqr(t))' in '$(sqr(t))'" },
    { "number-bare", ".model:6: a function without its ( at 'sin 30)' in '$(sin 30)'" },
    { "number-operator", ".model:6: an operator or ) is missing at 't)' in '$(2t)'" },
    { "number-missing", ".model:6: a number is missing at ')' in '$(2 + )'" },
    { "number-second", ".model:6: a second number is missing at ')' in '$(min(3))'" },
    { "number-surplus", ".model:6: one number too many before at ')' in '$(sqrt(1, 2))'" },
    { "number-root", ".model:6: '$(sqrt(-1))' has no value, it is no number" },
    { "number-plain", ".model:6: not a number: 't*2', expected: gravity GX GY; arithmetic is "
      "$(...)" },
    { "number-deep", ".model:6: too many parentheses or signs at "
      "'((((((((((((((((((((((((((((((' in '$((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((('" },
    { "of-missing", ".model:7: a word is missing, expected: fix WHERE [of BLOCK] [x [by U]] [y [by V]]" },
    { "of-other-block", ".model:7: no node there of block b, the nearest is node 5 at 0.5 1" },
    { "of-unknown", ".model:7: unknown block 'c', expected one that the model has, such as a, b" },
    { "output-field", ".model:7: 'szz', expected one of u|v|rotation|sxx|syy|sxy|mises|s1|s2|vx|vy|spin" },
    { "output-scale", ".model:7: scale is 0, expected more than 0" },
    { "plane-kind", ".model:7: 'stain', expected one of stress|strain" },
    { "plane-twice", ".model:8: plane for the second time, after line 7, expected it once" },
    { "ramp-negative", ".model:7: ramp is -1, expected 0 or more" },
    { "unknown-block-nearest", ".model:4: unknown block 'aa', expected one that the model has, such as a, b" },
    { "unknown-set-or-block", ".model:7: unknown set 'slab', expected one that the model has, such as a, b" },
    { "water-density", ".model:7: density is 0, expected more than 0" },
    { "water-dry", ".model:7: no edge there lies below y = 0.5, expected one under water" },
    { "water-no-edge", ".model:7: no boundary edge has both ends there, expected one" },
    { "water-no-level", ".model:7: a word is missing, expected: water WHERE [of BLOCK] LEVEL [density VALUE]" },
    { "water-without-gravity", ".model:6: water without weight, expected gravity" },
    { "set-of-another-block", ".model:7: no node there of block b, expected a place that names one" },
};

START_TEST(wrong_input_is_named_with_its_line_and_nothing_is_written)
{
    const wrong *w = &wrongs[_i];
    char expected[LONG], said[LONG];

    ck_assert_int_eq(shell("rm -rf out/model/bad; %s/bbm tests/bad/%s.model -o out/model/bad -m out/model/bad.mtx "
                           "> out/model/bad.out 2> out/model/bad.err", BUILD, w->name), 2);
    snprintf(expected, sizeof expected, "tests/bad/%s%s\n", w->name, w->message);
    ck_assert_str_eq(slurp("out/model/bad.err", said), expected);
    ck_assert_str_eq(slurp("out/model/bad.out", said), "");
    ck_assert_int_ne(access("out/model/bad", F_OK), 0);
    ck_assert_int_ne(access("out/model/bad.mtx", F_OK), 0);
}
END_TEST

START_TEST(every_file_of_wrong_input_has_its_message_in_the_table)
{
    char text[LONG];

    ck_assert_int_eq(shell("ls tests/bad/*.model | wc -l > out/model/count"), 0);
    ck_assert_int_eq(atoi(slurp("out/model/count", text)), (int)(sizeof wrongs / sizeof *wrongs));
}
END_TEST

START_TEST(a_missing_file_is_status_2)
{
    char said[LONG];

    ck_assert_int_eq(shell("%s/bbm nowhere.model 2> out/model/bad.err", BUILD), 2);
    ck_assert_str_eq(slurp("out/model/bad.err", said),
                     "nowhere.model: nowhere.model cannot be read: No such file or directory\n");
}
END_TEST

START_TEST(wrong_arguments_are_status_2_and_help_is_status_0)
{
    char said[LONG];
    static const struct { const char *arguments; int status; } call[] = {
        { "", 2 }, { "-x a.model", 2 }, { "a.model b.model", 2 }, { "a.model -o", 2 }, { "-h", 0 },
        { "a.model -m a.model", 2 }, { "a.model -m nodes.csv", 2 }, { "a.model -m .mtx", 2 }, { "--version", 0 },
    };

    for (size_t k = 0; k < sizeof call / sizeof *call; k++)
        ck_assert_int_eq(shell("%s/bbm %s > out/model/said 2> out/model/bad.err", BUILD, call[k].arguments),
                         call[k].status);
    ck_assert_str_eq(slurp("out/model/said", said), "bbm " BBM_VERSION "\n");
}
END_TEST

/* ------------------------------------------------------------------------------------------------ what it computes */

/* A result of cases/models against theory. `most` is absolute. */
typedef struct { const char *model, *file, *row, *column; double expected, most; } target;

static const target targets[] = {
    /* A converged finite element; 12 cells in the length of a beam that bends are good for 0.5 %. */
    { "exp1", "history.csv", "1,", "middle_v", -2.8449e-3, 1.5e-5 },
    { "exp1", "history.csv", "1,", "late_v", -5.6758e-3, 3e-5 },
    { "exp1", "history.csv", "1,", "tip_u", 0, 1e-12 },
    /* The finite plate is some 10 % above the infinite one: bounds that a wrong factor breaks. */
    { "exp2", "history.csv", "1,", "side_u", 1.15e-6, 0.02e-6 },
    { "exp2", "nodes.csv", "177,plate", "sxx", 3.1e6, 0.1e6 },
    /* u = F t^2/(2 m), v = 0; the plate gives way by some 1e-6 m. Settling has moved it by 50 F dt^2/(2 m) before. */
    { "exp3", "history.csv", "0,", "P_u", 0.0025, 1e-5 },
    { "exp3", "history.csv", "200,", "P_u", 2.0025, 1e-4 },
    { "exp3", "history.csv", "200,", "P_v", 0, 1e-5 },
    { "exp3", "summary.csv", "200,", "kinetic", 20000, 2 },
    /* s = g (sin a - cos a tan phi) t^2/2 */
    { "incline", "history.csv", "100,", "corner_u", -0.78497, 3e-5 },
    { "incline", "history.csv", "100,", "corner_v", -0.45320, 3e-5 },
    /* The weight above the middle of the lowest block: 9.5 W; at rest. */
    { "column", "elements.csv", "2,b1,", "syy", -9.5 * 24525, 3 },
    { "column", "summary.csv", "1000,", "kinetic", 0, 1e-9 },
    { "overhang", "history.csv", "200,", "end_u", 0, 1e-3 },
    { "arch", "history.csv", "100,", "crown_v", 0, 2e-3 },
    /* P/(pi R t) and -3 P/(pi R t); the mesh has eight rings. */
    { "disc", "nodes.csv", "1,disc", "sxx", 0.3183e6, 0.02e6 },
    { "disc", "nodes.csv", "1,disc", "syy", -0.9549e6, 0.02e6 },
    /* The dam leans down the stream and stands. */
    { "dam", "history.csv", "", "crest_u", 1.7e-4, 0.35e-4 },
};

static void run_models(void)
{
    static const char *const name[] = { "exp1", "exp2", "exp3", "incline", "column", "overhang", "arch", "disc",
                                        "dam" };

    shell("rm -rf out/model; mkdir -p out/model");
    for (size_t k = 0; k < sizeof name / sizeof *name; k++)
        ck_assert_int_eq(shell("%s/bbm cases/models/%s.model -o out/model/%s > out/model/%s.log", BUILD, name[k],
                               name[k], name[k]), 0);
}

START_TEST(a_model_meets_theory)
{
    const target *t = &targets[_i];
    const double got = cell(t->model, t->file, t->row, t->column);

    ck_assert_msg(fabs(got - t->expected) <= t->most, "%s: %s is %.9g, expected %g within %g", t->model, t->column, got,
                  t->expected, t->most);
}
END_TEST

START_TEST(no_table_has_a_nan_and_no_file_is_left_half_written)
{
    ck_assert_int_eq(shell("! ls out/model/*/*.tmp 2> out/model/said && ! grep -il nan out/model/*/*.csv"), 0);
    ck_assert_int_eq(shell("grep -q '^CELLS 144 720$' out/model/exp1/step_000001.vtk"), 0);
}
END_TEST

/* Nodes 1 to 6, two squares side by side from (0,0) to (2,1), one block; held on the left, the lower corner in y. */
#define STRIP STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\nnode 5 2 0\nnode 6 2 1\n" \
    "element 1 b steel 1 2 3 4\nelement 2 b steel 2 5 6 3\nfix box 0 0 0 1 x\nfix at 0 0 y\nmonitor end node 6\n"

START_TEST(load_traction_and_pressure_agree)
{
    static const char *const end[] = {
        "load box 2 0 2 1 5e5 0\nstatic\n", "traction box 2 0 2 1 1e6 0\nstatic\n",
        "set right nodes 5 6\npressure set right -1e6\nstatic\n", "load node 5 2.5e5 0\nload at 2 1 2.5e5 0\nstatic\n",
    };
    char text[LONG];

    for (size_t k = 0; k < sizeof end / sizeof *end; k++) {
        snprintf(text, sizeof text, "%s%s", STRIP, end[k]);
        ck_assert_int_eq(run_text("pull", text), 0);
        /* u = s L/E = 1e6 * 2/2e11; the springs give nothing away after two augmentations, to 1e-9 of it. */
        ck_relative(cell("pull", "history.csv", "1,", "end_u"), 1e-5, 1e-9);
        ck_relative(cell("pull", "history.csv", "1,", "end_v"), -1.5e-6, 1e-9);
        /* An even stress: energy = force * u/2, and the work of the full load twice that. */
        ck_relative(cell("pull", "summary.csv", "1,", "elastic"), 2.5, 1e-8);
        ck_relative(cell("pull", "summary.csv", "1,", "external"), 5, 1e-8);
    }
}
END_TEST

START_TEST(the_order_of_statements_does_not_matter)
{
    ck_assert_int_eq(run_text("there", STRIP "traction box 2 0 2 1 1e6 0\nstatic\n"), 0);
    ck_assert_int_eq(shell("{ grep -v '^node\\|^element' out/model/there.model; grep '^node' out/model/there.model; } "
                           "| tac > out/model/back.model; grep '^element' out/model/there.model >> out/model/back.model; "
                           "%s/bbm -q out/model/back.model -o out/model/back", BUILD), 0);
    ck_relative(cell("back", "history.csv", "1,", "end_u"), cell("there", "history.csv", "1,", "end_u"), 1e-9);
}
END_TEST

START_TEST(a_pressure_turns_with_its_edge_and_a_traction_does_not)
{
    /* A square that spins freely with 1 rad/s, pushed on its trailing side: after dt it has turned by as much. */
    static const char text[] = STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\nelement 1 b steel 1 2 3 4\n"
        "velocity b 0 0 1.5707963267948966\nset left nodes 1 4\n%s set left %s\ndynamic dt 0.01 steps 100\n";
    char model[LONG];

    /* m = 3900 kg, f = 3900 N: a(t) = (cos wt, sin wt), w = pi/2, for t = 1: x = 4/pi^2, y = (1 - 2/pi) 2/pi */
    snprintf(model, sizeof model, text, "pressure", "7800");
    ck_assert_int_eq(run_text("turn", model), 0);
    const double pi = acos(-1);
    ck_near(cell("turn", "elements.csv", "1,b", "u"), 4 / (pi * pi), 0.5, 0.02);     /* dt/2 of lag: 1 % of 1 s */
    ck_near(cell("turn", "elements.csv", "1,b", "v"), (1 - 2 / pi) * 2 / pi, 0.5, 0.02);
    ck_relative(cell("turn", "elements.csv", "1,b", "rotation"), pi / 2, 1e-3);
    snprintf(model, sizeof model, text, "traction", "7800 0");
    ck_assert_int_eq(run_text("turn", model), 0);
    ck_near(cell("turn", "elements.csv", "1,b", "u"), 0.5, 0.5, 0.02);
    ck_near(cell("turn", "elements.csv", "1,b", "v"), 0, 0.5, 0.02);
}
END_TEST

/* The paper's linear update lets a block that turns swell, and gain energy by that: it is told. Its moment of inertia
 * is m/6, m = 3900 kg, and grows by 1 + (w dt)^2 a step, w = 1 rad/s. The exact update makes nothing. */
START_TEST(what_steps_make_beyond_the_work_of_loads_is_told)
{
    static const char *const text = STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\nelement 7 b steel 1 2 3 4\n"
        "velocity b 0 0 1\ndynamic dt 0.01 steps 50\nrotation %s\n";
    const double swollen = 3900 / 12.0 * (pow(1 + 1e-4, 50) - 1);
    char model[LONG];

    for (int k = 0; k < 2; k++) {
        snprintf(model, sizeof model, text, k ? "linear" : "exact");
        ck_assert_int_eq(run_text("gains", model), 0);
        ck_near(cell("gains", "summary.csv", "50,", "gained"), k ? swollen : 0, swollen, 1e-6);
    }
    ck_assert_int_eq(shell("%s/bbm out/model/gains.model -o out/model/gains > out/model/said", BUILD), 0);
    check_text("out/model/said", "no step made more than 1.0e-04 of its energy beyond");
}
END_TEST

START_TEST(a_shaken_block_follows_the_closed_form)
{
    double error[2];

    for (int k = 0; k < 2; k++) {
        char text[LONG];
        snprintf(text, sizeof text, STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nelement 7 b steel 1 2 3\n"
                 "shake 2 0 3.141592653589793\ndynamic dt %g steps %d\nmonitor p node 2\n", 0.01 / (k + 1),
                 100 * (k + 1));
        ck_assert_int_eq(run_text("shake", text), 0);
        /* u'' = -A sin wt   ->   u = A (sin wt - wt)/w^2, -A/w at t = 1 */
        error[k] = cell("shake", "history.csv", "", "p_u") + 2 / acos(-1);
    }
    ck_assert_double_lt(fabs(error[0]), 0.02);
    ck_relative(error[1], error[0] / 2, 0.02);           /* the paper's Newmark is of first order for forces in time */
}
END_TEST

START_TEST(a_step_with_velocity_factor_0_reports_the_kinetic_energy_that_it_had)
{
    static const char *const word[] = { "velocity_factor", "damping" };         /* they are the same */
    char text[LONG];

    snprintf(text, sizeof text, STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nelement 7 b steel 1 2 3\n"
             "gravity 0 -10\ndynamic dt 0.1 steps 3 %s 0\n", word[_i]);
    ck_assert_int_eq(run_text("damped", text), 0);
    ck_relative(cell("damped", "summary.csv", "3,", "kinetic"), 975.0, 1e-9);           /* v = g dt = 1 in each step */
}
END_TEST

START_TEST(an_initial_stress_pushes_the_wall)
{
    ck_assert_int_eq(run_text("stress", STRIP "stress b 1e6 0 0\nstatic\n"), 0);
    ck_relative(cell("stress", "history.csv", "1,", "end_u"), -1e-5, 1e-9);  /* free at the right: back to 0 */
    ck_near(cell("stress", "elements.csv", "1,", "sxx"), 0, 1e6, 1e-8);
}
END_TEST

START_TEST(statics_that_finds_no_equilibrium_is_status_1_and_keeps_its_steps)
{
    ck_assert_int_eq(run_text("few", STRIP "load node 6 0 -1e6\nstatic steps 1 tolerance 1e-12\n"), 1);
    check_text("out/model/few.err", "few.model: step 1: no equilibrium");
    ck_assert_double_lt(cell("few", "history.csv", "1,", "end_v"), 0);
    ck_assert_int_eq(run_text("few", STRIP "load node 6 0 -1e6\nstatic steps 30 tolerance 1e-8\n"), 0);
    ck_assert_int_eq(run_text("few", STRIP "load node 6 0 -1e6\nstatic\npcg iterations 1 coarse off\n"), 1);
    check_text("out/model/few.err", "step 1, 1 iterations");
}
END_TEST

/* ------------------------------------------------------------------------------------------------------- meshes */

START_TEST(both_versions_of_a_mesh_and_the_same_by_hand_agree)
{
    static const char *const version[] = { "22", "41" };

    ck_assert_int_eq(run_text("hand", STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\n"
                              "element 1 plate steel 1 2 3\nelement 2 plate steel 1 3 4\nset left nodes 1 4\n"
                              "fix set left\nload node 3 0 -1e6\nstatic\n"), 0);
    for (int k = 0; k < 2; k++) {
        char text[LONG];
        snprintf(text, sizeof text, STEEL "mesh ../../tests/mesh/square%s.msh\nuse steel on plate\nfix set left\n"
                 "load node 3 0 -1e6\nstatic\n", version[k]);
        ck_assert_int_eq(run_text("mesh", text), 0);
        ck_assert_double_eq(cell("mesh", "nodes.csv", "3,plate", "v"), cell("hand", "nodes.csv", "3,plate", "v"));
    }
}
END_TEST

START_TEST(a_fixed_block_does_not_hold_the_nodes_of_its_neighbour)
{
    /* Two squares that share nodes 2 and 3, drawn apart: the right one is free and falls. The left one is held by the
     * springs of its four vertices, which shorten by its weight over them, 2.6e-9 m, at most. */
    ck_assert_int_eq(run_text("apart", STEEL "node 1 0 0\nnode 2 1 0\nnode 3 1 1\nnode 4 0 1\nnode 5 2 0\nnode 6 2 1\n"
                              "element 1 a steel 1 2 3 4\nelement 2 b steel 2 5 6 3\nfixblock a\ngravity 0 -10\n"
                              "dynamic dt 0.01 steps 10\n"), 0);
    ck_near(cell("apart", "nodes.csv", "2,a", "v"), 0, 1, 2.6e-9);
    ck_relative(cell("apart", "nodes.csv", "2,b", "v"), -0.05, 1e-3);
}
END_TEST

/* An element with a hanging node, and two beside it that share it. */
START_TEST(a_block_in_pieces_is_said)
{
    char said[LONG];

    ck_assert_int_eq(run_text("pieces", "node 1 0 0\nnode 2 2 0\nnode 3 2 1\nnode 4 1 1\nnode 5 0 1\nnode 6 2 2\n"
                              "node 7 1 2\nnode 8 0 2\nmaterial rock E 1e10 nu 0.25 density 2500\n"
                              "element 10 beam rock 1 2 3 5\nelement 20 beam rock 5 4 7 8\n"
                              "element 30 beam rock 4 3 6 7\nfixblock beam\ngravity 0 -10\ndynamic dt 0.01 steps 1\n"), 0);
    ck_assert_str_eq(slurp("out/model/pieces.err", said), "out/model/pieces.model: warning: block 'beam' is in 2 pieces "
                     "that no bond joins, with the elements 10, 20; elements are bonded along sides whose two nodes they "
                     "share\n");
}
END_TEST

/* A block that slides off a slope. */
START_TEST(statics_names_the_block_that_slides)
{
    char said[LONG];

    ck_assert_int_eq(run_text("slides", STEEL "node 1 0 0\nnode 2 4 0\nnode 3 4 1\nnode 4 0 1\nnode 5 1 1\nnode 6 2 1\n"
                              "node 7 2 2\nnode 8 1 2\nelement 1 base steel 1 2 3 4\nelement 9 stone steel 5 6 7 8\n"
                              "fixblock base\ngravity 5 -9.81\ncontact friction 20\nstatic\n"), 1);
    ck_assert_str_eq(slurp("out/model/slides.err", said), "out/model/slides.model: it falls: step 1: block 'stone' "
                     "(element 9) slides on block 'base' (element 1), and goes on\n");
}
END_TEST

Suite *model_suite(void)
{
    Suite *s = suite_create("model");
    TCase *t = tcase_create("wrong input");

    tcase_set_timeout(t, 60);
    tcase_add_unchecked_fixture(t, run_models, NULL);
    tcase_add_loop_test(t, wrong_input_is_named_with_its_line_and_nothing_is_written, 0,
                        sizeof wrongs / sizeof *wrongs);
    tcase_add_test(t, every_file_of_wrong_input_has_its_message_in_the_table);
    tcase_add_test(t, a_missing_file_is_status_2);
    tcase_add_test(t, wrong_arguments_are_status_2_and_help_is_status_0);
    tcase_add_loop_test(t, a_model_meets_theory, 0, sizeof targets / sizeof *targets);
    tcase_add_test(t, no_table_has_a_nan_and_no_file_is_left_half_written);
    tcase_add_test(t, load_traction_and_pressure_agree);
    tcase_add_test(t, the_order_of_statements_does_not_matter);
    tcase_add_test(t, a_pressure_turns_with_its_edge_and_a_traction_does_not);
    tcase_add_test(t, what_steps_make_beyond_the_work_of_loads_is_told);
    tcase_add_test(t, a_shaken_block_follows_the_closed_form);
    tcase_add_loop_test(t, a_step_with_velocity_factor_0_reports_the_kinetic_energy_that_it_had, 0, 2);
    tcase_add_test(t, an_initial_stress_pushes_the_wall);
    tcase_add_test(t, statics_that_finds_no_equilibrium_is_status_1_and_keeps_its_steps);
    tcase_add_test(t, both_versions_of_a_mesh_and_the_same_by_hand_agree);
    tcase_add_test(t, a_fixed_block_does_not_hold_the_nodes_of_its_neighbour);
    tcase_add_test(t, a_block_in_pieces_is_said);
    tcase_add_test(t, statics_names_the_block_that_slides);
    suite_add_tcase(s, t);
    return s;
}
