"""Plot of cable tensions during the push of Mirletz et al. on Tetraspine3: plot_push.py PICTURE.png"""
import sys
import matplotlib.pyplot as plt
import taut
trace = taut.run(taut.load("experiments/push_20n.yaml")).trace
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for name in (channel for channel in trace.channels if channel.endswith("/tension_n")):
    axes.plot(trace.time_s, trace[name], "-" if "_1/" in name else "--", label=name.split("/")[1])
axes.set(xlabel="time [s]", ylabel="tension [N]", xlim=(0, 60))
axes.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
figure.savefig(sys.argv[1], dpi=150)
