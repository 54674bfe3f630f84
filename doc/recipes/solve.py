import numpy as np
from scipy.io import mmread
from scipy.sparse.linalg import spsolve
D = spsolve(mmread("K.mtx").tocsc(), mmread("K.mtx.rhs")).reshape(-1, 6)
E = np.loadtxt("beam/elements.csv", delimiter=",", skiprows=1, usecols=(4, 5, 6))
print(abs(D[:, :3] - E).max() < 1e-8*abs(E).max())
