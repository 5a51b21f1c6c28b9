/// State rows of a group of worlds: the list of all data of a group, for serialization and hashes.
/// The list determines the memory layout, the access in a step, start values, contents of
/// snapshots, and the treatment of halted worlds. A step includes this header, so it does not use
/// the standard library (kernel.inl).
#pragma once

namespace taut::sim {

/// Number of elements of a row.
enum class Per {
  kWorld,
  kBody,
  kCable,
  kMotor,
  kWheel,
  kSpan,
  kSlip,
  kTouch,     ///< Cables with wrapping around terrain or rods.
  kTouchRod,  ///< Pairs of such a cable and a rod around which it may wrap.
  kBend,      ///< Bends on edges and rods: kMostBends per such cable.
  kNode,
  kJoint,
  kJointRow,
  kMotion,
  kBodyPair,  ///< Pairs with static bodies, then pairs of moving bodies or near bodies.
  kNear,      ///< Bodies, in models with lists of near bodies.
  kKept,      ///< Pairs of shapes with a cache of near parts (contact_cache.h).
  kContact
};

/// Purpose of a row. Rows are stored in this order.
enum class Role {
  kState,      ///< Evolves or is a command; in snapshots and hashes.
  kParameter,  ///< Changed only by setters; in snapshots and hashes.
  kReading,    ///< Readings of the last step, which no step uses; in snapshots.
  kMemory,     ///< Contacts of the last step; snapshots and hashes contain those with a key.
  kDerived,    ///< Computed from other rows, or only reported; not in snapshots.
  kSensed,     ///< Derived row that is computed on demand (Group::sensed).
};

/// Treatment of a row if the world is not finite after a step.
enum class Halted {
  kStays,     ///< Not written by the step, or only with finite values.
  kGoesBack,  ///< Restored to its value at the start of the step.
  kZero,
  kForgets,  ///< Set to kNoKey, which clears the contact memory.
};

/// State of a motor between steps (dc_motor.inl).
template <class Num>
struct MotorNumbers {
  Num speed;                  ///< Rotor speed, positive when winding in [rad/s].
  Num gap;                    ///< Rest length from the gear angle minus actual rest length [m].
  Num winding, housing;       ///< Temperatures [C].
  Num duty, current, supply;  ///< Of the last step: mean duty [1], mean current [A], voltage [V].
  Num from_supply, to_cable, in_winding;  ///< Energies [J].
};
/// Commands to a motor.
template <class Num>
struct MotorOrders {
  Num duty;     ///< Commanded duty [1].
  Num by_duty;  ///< 1: use the commanded duty; 0: follow the target of the cable.
  Num on;       ///< 1: the driver is on; 0: it is off.
};

/// Bend: contact of a cable with a terrain edge or rod (cable_wrapping.inl).
template <class Num>
struct WrapPointNumbers {
  Num key;    ///< Key of the edge or rod (cable_edges.h), or kNoKey. Bends in use are first.
  Num body;   ///< Index of the body or of the world.
  Num angle;  ///< Angle of the cable about the axis, from the previous to the next point [rad].
  Num most;   ///< Largest angle at which the cable does not pass through the shape [rad].
  /// Half the length of the cylinder around which the cable bends; distance from its axis to the
  /// center line of the cable [m].
  Num half, radius;
  Num center[3], axis[3];  ///< In frame P [m], [1].
};

/// Doubles per element.
inline constexpr int kWidthNumber = 1, kWidthV3 = 3, kWidthQ4 = 4;
inline constexpr int kWidthMotor = sizeof(MotorNumbers<double>) / sizeof(double);
inline constexpr int kWidthWrapPoint = sizeof(WrapPointNumbers<double>) / sizeof(double);
inline constexpr int kWidthOrders = sizeof(MotorOrders<double>) / sizeof(double);

}  // namespace taut::sim

/// ROW(name, type, elements per ..., role, treatment when halted, start value). `start` is a
/// function of start_values.h. Snapshots and hashes follow the order of this list.
// clang-format off
#define TAUT_STATE_ROWS(ROW) \
  ROW(time,           Number, kWorld,    kState,     kStays,    Zero)             /* [s] */ \
  ROW(last_step,      Number, kWorld,    kState,     kStays,    Zero)             /* [s] */ \
  ROW(pos,            V3,     kBody,     kState,     kGoesBack, CentreOfMass)     /* [m] */ \
  ROW(quat,           Q4,     kBody,     kState,     kGoesBack, PrincipalFrame)   /* q_WP */ \
  ROW(vel,            V3,     kBody,     kState,     kGoesBack, Velocity)         /* [m/s] */ \
  ROW(mom,            V3,     kBody,     kState,     kGoesBack, AngularMomentum)  /* about com, in W [kg m^2/s] */ \
  ROW(old_vel,        V3,     kBody,     kState,     kStays,    Velocity)         /* vel before the last step */ \
  ROW(old_spin,       V3,     kBody,     kState,     kZero,     Spin)             /* angular velocity before the last step [rad/s] */ \
  ROW(held_torque,    V3,     kBody,     kState,     kZero,    Zero)             /* torque of contacts and stiff cables in the last step [N m]; 0 after a landing */ \
  ROW(rest,           Number, kCable,    kState,     kGoesBack, RestLength)       /* [m] */ \
  ROW(rest_rate,      Number, kCable,    kState,     kGoesBack, Zero)             /* [m/s] */ \
  ROW(wheel_angle,    Number, kWheel,    kState,     kGoesBack, WheelAngle)       /* angle about it from point to point, with whole turns [rad] */ \
  ROW(span_rest,      Number, kSpan,     kState,     kGoesBack, SpanRest)         /* [m] */ \
  ROW(span_tension,   Number, kSpan,     kState,     kZero,     SpanTension)      /* mean over the last step [N] */ \
  ROW(slip_place,     Number, kSlip,     kState,     kGoesBack, SlipPlace)        /* middle of a wheel's arc, on the wheel [rad] */ \
  ROW(slip_loss,      Number, kSlip,     kState,     kGoesBack, Zero)             /* energy lost to friction [J] */ \
  ROW(slip_along,     Number, kSlip,     kState,     kGoesBack, NotHeld)          /* middle of a bend's arc, along its axis [m], or kNotHeld */ \
  ROW(slip_height,    Number, kSlip,     kState,     kGoesBack, NotHeld)          /* middle of an arc in the last step, along its axis [m], or kNotHeld */ \
  ROW(touch_side,     Number, kTouchRod, kState,     kZero,     TouchSide)        /* side of the rod on which a part of the cable passes it (cable_rods.inl) */ \
  ROW(bend,           WrapPoint,   kBend,     kState,     kForgets,  NoWrapPoint)           /* see WrapPointNumbers */ \
  ROW(motor,          Motor,  kMotor,    kState,     kGoesBack, MotorAtRest) \
  ROW(orders,         Orders, kMotor,    kState,     kStays,    FollowTarget) \
  ROW(target,         Number, kCable,    kState,     kStays,    RestLength)       /* [m] */ \
  ROW(tension,        Number, kCable,    kState,     kZero,     Tension)          /* [N] */ \
  ROW(joint_angle,    Number, kJoint,    kState,     kGoesBack, Zero)             /* of hinges, with whole turns [rad] */ \
  ROW(joint_load,     Number, kJointRow, kState,     kZero,     Zero)             /* along a row [N] */ \
  ROW(motion_work,    Number, kMotion,   kState,     kGoesBack, Zero)             /* work of the motion on other bodies [J] */ \
  ROW(node_force,     V3,     kNode,     kState,     kStays,    Zero)             /* in W [N] */ \
  ROW(mass,           Number, kBody,     kParameter, kStays,    Mass)             /* [kg] */ \
  ROW(inv_mass,       Number, kBody,     kParameter, kStays,    InverseMass)      /* [1/kg] */ \
  ROW(inertia,        V3,     kBody,     kParameter, kStays,    Moments)          /* principal [kg m^2] */ \
  ROW(inv_inertia,    V3,     kBody,     kParameter, kStays,    InverseMoments)   /* [1/(kg m^2)] */ \
  ROW(stiffness,      Number, kCable,    kParameter, kStays,    Stiffness)        /* [N/m] */ \
  ROW(damping,        Number, kCable,    kParameter, kStays,    Damping)          /* [N s/m] */ \
  ROW(stiff_k,        Number, kCable,    kParameter, kStays,    ByJudgeStiffness) /* [1/s^2] */ \
  ROW(friction_scale, Number, kWorld,    kParameter, kStays,    One)              /* [1] */ \
  ROW(gravity,        V3,     kWorld,    kParameter, kStays,    Gravity)          /* [m/s^2] */ \
  ROW(halted,         Number, kWorld,    kParameter, kStays,    Zero)             /* 1: the world is not stepped */ \
  ROW(mean_step,      Number, kWorld,    kReading,   kZero,     Zero)             /* step over which readings of stiff cables are means [s]; 0: not means */ \
  ROW(mean_elastic,   Number, kCable,    kReading,   kZero,     Zero)             /* mean spring force of a stiff cable over that step [N] */ \
  ROW(contact_key,    Number, kContact,  kMemory,    kForgets,  NoKey)            /* key of a contact: pair and feature; -1: none */ \
  ROW(contact_force,  V3,     kContact,  kMemory,    kStays,    Zero)             /* in W [N] */ \
  ROW(contact_slip,   Number, kContact,  kMemory,    kStays,    SlipUnknown)      /* 1 slid, 0 stuck */ \
  ROW(contact_arm,    V3,     kContact,  kDerived,   kStays,    Zero)             /* from body a, in W [m] */ \
  ROW(contact_normal, V3,     kContact,  kDerived,   kStays,    Zero)             /* in W */ \
  ROW(contact_gap,    Number, kContact,  kDerived,   kStays,    Zero)             /* [m] */ \
  ROW(joint_force,    V3,     kJoint,    kDerived,   kZero,     Zero)             /* on body b, in W [N] */ \
  ROW(joint_torque,   V3,     kJoint,    kDerived,   kZero,     Zero)             /* on body b about its point [N m] */ \
  ROW(motion_force,   V3,     kMotion,   kDerived,   kZero,     Zero)             /* on its body, in W [N] */ \
  ROW(motion_torque,  V3,     kMotion,   kDerived,   kZero,     Zero)             /* on its body, about its origin [N m] */ \
  ROW(clearance,      Number, kBodyPair, kDerived,   kStays,    Zero)             /* lower bound of the distance [m] */ \
  ROW(near_m,         Number, kWorld,    kDerived,   kStays,    Zero)             /* distance within which the list of near bodies was complete [m]; 0: unknown */ \
  ROW(near_pos,       V3,     kNear,     kDerived,   kStays,    Zero)             /* pos when that list was made [m] */ \
  ROW(near_quat,      Q4,     kNear,     kDerived,   kStays,    PrincipalFrame)           /* quat, likewise */ \
  ROW(cache_from,     V3,     kKept,     kDerived,   kStays,    Zero)             /* end of a rod at its last query [m] */ \
  ROW(quiet_to,       V3,     kKept,     kDerived,   kStays,    Zero)             /* other end [m] */ \
  ROW(quiet_limit,    Number, kKept,     kDerived,   kStays,    Zero)             /* distance from its axis without contacts at that query [m]; 0: unknown */ \
  ROW(touch_from,     V3,     kTouch,    kDerived,   kStays,    Zero)             /* start of a free cable at its last query [m] */ \
  ROW(touch_to,       V3,     kTouch,    kDerived,   kStays,    Zero)             /* end [m] */ \
  ROW(touch_free,     Number, kTouch,    kDerived,   kStays,    Zero)             /* free distance around it at that query [m]; 0: unknown */ \
  ROW(residual,       Number, kWorld,    kDerived,   kStays,    Zero)             /* of the last solve [m/s] */ \
  ROW(linear_solves,  Number, kWorld,    kDerived,   kStays,    Zero)             /* of the last step */ \
  ROW(relaxation,        Number, kWorld,    kDerived,   kStays,    Zero)             /* of inconsistent contacts in the last step, see WorldStatus [m/s] */ \
  ROW(sense_span_length, Number, kSpan,  kSensed,    kStays,    Zero)             /* [m] */ \
  ROW(sense_span_rest, Number, kSpan,    kSensed,    kStays,    Zero)             /* after the pending slip [m] */ \
  ROW(sense_slip_loss, Number, kSlip,    kSensed,    kStays,    Zero)             /* with the pending slip [J] */ \
  ROW(sense_length,   Number, kCable,    kSensed,    kStays,    Zero)             /* [m] */ \
  ROW(sense_rate,     Number, kCable,    kSensed,    kStays,    Zero)             /* [m/s] */ \
  ROW(sense_tension,  Number, kCable,    kSensed,    kStays,    Zero)             /* [N] */ \
  ROW(sense_elastic,  Number, kCable,    kSensed,    kStays,    Zero)             /* [N] */
// clang-format on
