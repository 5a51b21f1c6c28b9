"""Natural frequencies and impulse response from `taut analyze --linear FILE`: linear_system.py FILE INPUT OUTPUT"""

import sys

import h5py
import numpy as np

path, tapped, seen = sys.argv[1:]
with h5py.File(path, "r") as file:
    A, B, C, D = (file[name][:] for name in "ABCD")
    period_s = file.attrs["period_s"]
    inputs = [name.decode() for name in file["inputs/name"][:]]
    outputs = [name.decode() for name in file["outputs/name"][:]]
    unit = file["outputs/unit"][outputs.index(seen)].decode()

print(f"{A.shape[0]} states, {B.shape[1]} inputs, {C.shape[0]} outputs, a tick of {period_s:g} s")
for z in np.linalg.eigvals(A):
    s = np.log(z) / period_s
    if s.imag > 1e-3 and abs(z) > 0.5:  # one of each pair; excludes decay within a tick or two
        print(f"swings at {s.imag / 2 / np.pi:.4f} Hz, damping {abs(s.real) / abs(s):.4f}")

x, u = np.zeros(A.shape[0]), np.zeros(B.shape[1])
u[inputs.index(tapped)] = 1.0  # for 10 ms
y = []
for tick in range(round(1 / period_s)):
    now = u if tick * period_s < 0.01 else 0 * u
    y.append(C[outputs.index(seen)] @ x + D[outputs.index(seen)] @ now)
    x = A @ x + B @ now
print(f"a tap moves {seen} by {max(y):.6f} {unit} at most, after {np.argmax(y) * period_s:.3f} s")
