"""Tensegrity statics (self-stress, mechanisms) with the matrices of `taut export structure`."""

import sys

import numpy as np

folder = sys.argv[1]
N, C_b, C_s, q, S = (np.loadtxt(f"{folder}/{name}.csv", delimiter=",", ndmin=2) for name in ("N", "C_b", "C_s", "q", "S"))
C, q = np.vstack([C_b, C_s]), q.ravel()
H = N @ C.T  # member vectors as columns
print("forces balance at all nodes:", np.allclose(H @ np.diag(q) @ C, 0, atol=1e-9))

# Equilibrium in the force densities: A_1 q = w, three rows per node.
A_1 = np.vstack([np.kron(C.T[node], np.ones((3, 1))) * H for node in range(N.shape[1])])
_, sizes, rows = np.linalg.svd(A_1)
rank = int(np.sum(sizes > 1e-9 * sizes[0]))
print(f"{C.shape[0]} members, rank {rank}: {C.shape[0] - rank} state of self-stress, {3 * N.shape[1] - 6 - rank} mechanism")
print(f"of it q is {abs(rows[-1] @ q) / np.linalg.norm(q):.6f}")
print(f"q of a rod over q of a string of the base: {q[0] / q[len(C_b)]:.6f}")
print(f"lengths of clusters: {np.round(np.unique(np.round(S @ np.linalg.norm(H, axis=0), 6)), 6)} m")
