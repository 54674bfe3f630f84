# python3 modes.py K.mtx: the first natural frequencies [Hz] of K and its masses
import math
import sys
from scipy.io import mmread
from scipy.sparse.linalg import eigsh

K, M = (mmread(sys.argv[1] + end).tocsc() for end in ("", ".mass"))
values = eigsh(K, 4, M, sigma=0)[0]
print(*(f"{math.sqrt(v) / (2 * math.pi):.2f}" for v in sorted(values)))
