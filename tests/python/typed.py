"""Program for type checkers: they must report the lines marked as wrong, and no others."""

import numpy as np

import taut
import taut.gym

experiment = taut.load("experiment.yaml", friction=0.5)
batch = taut.Batch(experiment, worlds=2, simd="avx2")
tension_n: "np.ndarray" = batch.tension_n(out=np.zeros((2, 12)))
batch.step(1e-3, 10, rest_length_target_m=[[0.1] * 12] * 2)
ran: taut.Run = taut.run(experiment, progress=lambda time_s, duration_s: None)
largest: float = max(ran.max_tension_n.values())
view: taut.View = taut.view(ran, ["runs/push_20n"], height_px=600)
ran.save("runs/typed")
frame = ran.trace.to_pandas()
envs = taut.gym.make_vec("experiment.yaml", 4, autoreset_mode=taut.gym.AutoresetMode.SAME_STEP)
rows: "np.ndarray" = taut.rollout(experiment, {"measure": "distance"}, [{"seed": 3}], threads=2)
ahead: "np.ndarray" = batch.rollout(np.zeros((2, 5, 12)), 1e-3, 10, start=batch.save())
study: taut.Study = taut.learn("study.yaml", "runs/study", progress=lambda done, budget, best: None)
best: float = study.best["frequency"]
verdict: str = taut.fit("fit.yaml").data["judgement"]
tensions: "np.ndarray" = taut.analyze(experiment.robot).tension_n
poles: "np.ndarray" = np.linalg.eigvals(taut.linear_system(experiment).A)
path: str = taut.data_path("models", "prism3.yaml")

taut.rollout(experiment, 3, 1)  # type: ignore[arg-type]
batch.rows.rest_length_target_m = 3  # type: ignore[misc, assignment]
batch.step("fast")  # type: ignore[arg-type]
batch.tensions()  # type: ignore[attr-defined]
hash_of: str = batch.hash(0)  # type: ignore[assignment]
