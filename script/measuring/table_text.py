"""Names of settings and engines, and formats of numbers, common to all tables."""

SETTINGS = {  # in the order of the tables
    ("taut", "default"): "taut",
    ("mujoco", "euler_pyramidal"): "MuJoCo, Euler, pyramidal cones",
    ("mujoco", "euler_elliptic"): "MuJoCo, Euler, elliptic cones",
    ("mujoco_wasm", "euler_pyramidal"): "MuJoCo 3 (WebAssembly), Euler, pyramidal cones",
    ("mujoco_wasm", "euler_elliptic"): "MuJoCo 3 (WebAssembly), Euler, elliptic cones",
    ("bullet", "iterations_10"): "Bullet, 10 iterations",
    ("bullet", "iterations_50"): "Bullet, 50 iterations",
    ("bullet", "two_directions"): "Bullet, 10 iterations, two friction directions",
    ("ode", "quick_10"): "ODE, quick step, 10 iterations",
    ("ode", "full_step"): "ODE, full step",
}
NOTHING = "-"


def number(value, digits=3):
    """Rounds to significant digits and separates groups of three: 1 230 000."""
    if value == 0:
        return "0"
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:,.0f}".replace(",", " ") if abs(rounded) >= 10 ** (digits - 1) else f"{rounded:.{digits}g}"


def count(value):
    """Formats all digits of an integer: 12 345."""
    return f"{value:,}".replace(",", " ")
