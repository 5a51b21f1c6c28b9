import sys

import h5py
import matplotlib.pyplot as plt

for path in sys.argv[1:]:
    with h5py.File(path, "r") as trace:
        time_s = trace["time_s"][:]
        tension_n = trace["cable/hanger/tension_n"][:]
        print(f"{path}: {len(time_s)} rows, hanger {tension_n.min():.2f} to {tension_n.max():.2f} N")
        plt.plot(time_s, tension_n, label=path)
plt.xlabel("time [s]")
plt.ylabel("tension of the hanger [N]")
plt.legend()
plt.savefig("hanger.png")
