"""Ratio of the speeds of two lanes in WebAssembly and natively (script/wasm --bench): both programs run alternately,
so that other load affects both, and the result is the median of the ratios."""

import json
import statistics
import subprocess
import sys

ROUNDS = 7
EXPERIMENTS = ["push_20n", "drop_six_strut", "hills", "puppy_stand", "wall"]


def measured(command):
    run = subprocess.run([*command, *(f"share/experiments/{name}.yaml" for name in EXPERIMENTS)], capture_output=True,
                         text=True, check=True)
    return [json.loads(line) for line in run.stdout.splitlines()]


def main():
    # If fetch existed, code by emscripten 3.1.6 would load its file as in a browser.
    here, wasm = [sys.argv[1]], ["node", "--no-experimental-fetch", sys.argv[2]]
    ratios = {}
    for _ in range(ROUNDS):
        for native, browser in zip(measured(here), measured(wasm)):
            if (native["hash"], native["lanes"]) != (browser["hash"], browser["lanes"]):
                raise SystemExit(f"not the same: {native} and {browser}")
            ratios.setdefault(native["experiment"], []).append((native["us"] / browser["us"], native["us"], browser["us"]))
    print(f"{'experiment':18} {'here':>9} {'WebAssembly':>12}   ratio of rates")
    for name, runs in ratios.items():
        ratio, *_ = (statistics.median(column) for column in zip(*runs))
        _, native, browser = (min(column) for column in zip(*runs))
        print(f"{name:18} {native:6.2f} us {browser:9.2f} us   {ratio:.2f}")
    medians = [statistics.median(run[0] for run in runs) for runs in ratios.values()]
    print(f"two worlds a step, same bits; least ratio {min(medians):.2f}, median {statistics.median(medians):.2f}")


main()
