"""Published facts about the paper's robot, and ranges of the unpublished numbers of its motor boards."""

# Gear and spool, and keys of the motor. Of the second and third drive, winding and gear are those of data sheets and
# measurements; the spool is assumed.
DRIVES = {
    "1524T012SR, 76:1": ("", ""),
    "1524T006SR, 141:1": ("gear_ratio: 141, spool_radius_m: 0.005",
                          "resistance_ohm: 5.1\n    torque_constant_n_m_per_a: 0.006"),
    "1524E006S123, 141:1": ("gear_ratio: 141, spool_radius_m: 0.005",
                            "resistance_ohm: 11\n    torque_constant_n_m_per_a: 0.00419"),
}
# Ranges of the unpublished numbers, uniform in their logarithm. integral_s: proportional gain over integral gain.
RANGES = {
    "boards.force_p_per_n": (0.002, 0.2),
    "integral_s": (0.01, 0.3),
    "boards.velocity_input_scale": (0.05, 1.0),
    "boards.tension_filter_share": (0.05, 0.5),
    "model.friction": (0.8, 1.25),
}

# Largest tensions of NTRT [N] (docs/validation/virtual_robot.md), and the published errors of NTRT relative to the
# robot. The paper does not say which of the two was larger.
NTRT = {"push": (32.29, 0.061), "sine": (26.93, 0.079), "gait": (30.24, 0.016)}
LIMITS = {run: (simulated / (1 + error), simulated / (1 - error)) for run, (simulated, error) in NTRT.items()}


def misfit(member):
    """Returns by how far the largest tensions are outside their limits, as a sum of relative differences."""
    return sum(max(0, low / member[run]["max_n"] - 1, member[run]["max_n"] / high - 1) for run, (low, high) in LIMITS.items())
