"""What a type checker has to say of a program that uses taut: nothing, but for the lines that are meant to be wrong."""

import numpy as np

import taut
import taut.gym

experiment = taut.load("experiment.yaml", friction=0.5)
batch = taut.Batch(experiment, worlds=2, simd="avx2")
tension_n: "np.ndarray" = batch.tension_n(out=np.zeros((2, 12)))
batch.step(1e-3, 10, rest_length_target_m=[[0.1] * 12] * 2)
ran: taut.Run = taut.run(experiment, progress=lambda time_s, duration_s: None)
largest: float = max(ran.max_tension_n.values())
frame = ran.trace.to_pandas()
envs = taut.gym.make_vec("experiment.yaml", 4, autoreset_mode=taut.gym.AutoresetMode.SAME_STEP)

batch.step("fast")  # type: ignore[arg-type]
batch.tensions()  # type: ignore[attr-defined]
hash_of: str = batch.hash(0)  # type: ignore[assignment]
