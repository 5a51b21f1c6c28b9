"""Generalization of a policy and a sine gait to changed conditions: roll_elsewhere.py FOLDER, the folder of ppo.py's
training.

Prints JSON, a list of [change, meters of the policy, meters of the sine]. For the python3 of taut's module.
"""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples"))
import ppo  # noqa: E402
import ppo_play  # noqa: E402
import taut.gym  # noqa: E402

SECONDS = 60
CHANGES = {
    "as described": "",
    "steps of 0.5 ms": "step_s: 0.0005\n",
    "steps of 0.25 ms": "step_s: 0.00025\n",
    "friction 0.25": "parameters: {ground_friction: 0.25}\n",
    "friction 1": "parameters: {ground_friction: 1}\n",
    "masses - 20 %": "scale: [{mass: 0.8}]\n",
    "masses + 20 %": "scale: [{mass: 1.2}]\n",
    "stiffnesses - 20 %": "scale: [{stiffness: 0.8}]\n",
    "stiffnesses + 20 %": "scale: [{stiffness: 1.2}]\n",
}


def main():
    folder = pathlib.Path(sys.argv[1])
    learner = ppo.Learner(taut.gym.make_vec(str(ppo.TASK)), 0, ppo.Settings())
    learner.load(folder / "policy.pt", same=["channels"])
    (folder / "elsewhere").mkdir(exist_ok=True)
    print(json.dumps([[name, ppo_play.roll(learner.policy, ppo.TASK, 0, SECONDS, folder / "elsewhere", more),
                       ppo_play.roll_by_sine(0, SECONDS, folder / "elsewhere", more)] for name, more in CHANGES.items()]))


if __name__ == "__main__":
    main()
