/// Every row that a group of worlds keeps, once. Where it lies, how a step reaches it, how it
/// starts, what a snapshot holds and what becomes of it when a world is halted all follow from this
/// list. Without the standard library: the step includes it.
#pragma once

namespace taut::sim {

/// How many of a row there are.
enum class Per {
  kWorld,
  kBody,
  kCable,
  kMotor,
  kWheel,
  kSpan,
  kSlip,
  kTouch,     ///< Cables that touch what they come to.
  kTouchRod,  ///< Pairs of such a cable and a rod that it may come to.
  kBend,      ///< Their room for places where they lie against an edge.
  kNode,
  kJoint,
  kJointRow,
  kMotion,
  kBodyPair,
  kKept,  ///< Pairs that keep what is near (near_parts.h).
  kContact
};

/// What it is for, in the order in which the rows lie.
enum class Role {
  kState,      ///< With commands: advances; in snapshots and hashes.
  kParameter,  ///< Does not change by itself; in snapshots and hashes.
  kReading,    ///< Observed values of the last step; no step reads them. In snapshots.
  kMemory,     ///< Of the contacts of the last step; snapshots and hashes have those with a key.
  kDerived,    ///< Follows from the rest or only reports; in no snapshot.
  kSensed,     ///< Derived, and only when somebody asks for it (Group::sensed).
};

/// What becomes of it when a step has left a world that is not finite.
enum class Halted {
  kStays,     ///< The step did not write it, or writes nothing there that is not finite.
  kGoesBack,  ///< To the start of the step.
  kZero,
  kForgets,  ///< Becomes kNoKey: a contact that is remembered no more.
};

/// What a motor keeps from step to step (dc_motor.inl).
template <class Num>
struct MotorNumbers {
  Num speed;             ///< Of the rotor, positive winding in [rad/s].
  Num gap;               ///< By this the rest length is shorter than the gear's angle says [m].
  Num winding, housing;  ///< Temperatures [C].
  Num duty, current, supply;  ///< Of the last step: mean duty [1], current [A], voltage [V].
  Num from_supply, to_cable, in_winding;  ///< Energies [J].
};
/// What it is told.
template <class Num>
struct MotorOrders {
  Num duty;     ///< [1]
  Num by_duty;  ///< 1: that duty; 0: follow the cable's target.
  Num on;       ///< 0: the driver is off.
};

/// Where a cable lies against an edge of the terrain or a rod (cable_bends.inl).
template <class Num>
struct BendNumbers {
  Num key;                 ///< Which one (cable_edges.h), or kNoKey. Those in use come first.
  Num body;                ///< Whose number, or that of the world.
  Num angle;               ///< From point to point about it [rad].
  Num most;                ///< The greatest angle that is not through what it belongs to [rad].
  Num half, radius;        ///< Half its length; to the middle of the cable [m].
  Num center[3], axis[3];  ///< In P [m], [1].
};

/// Numbers that one element has.
inline constexpr int kWidthNumber = 1, kWidthV3 = 3, kWidthQ4 = 4;
inline constexpr int kWidthMotor = sizeof(MotorNumbers<double>) / sizeof(double);
inline constexpr int kWidthBend = sizeof(BendNumbers<double>) / sizeof(double);
inline constexpr int kWidthOrders = sizeof(MotorOrders<double>) / sizeof(double);

}  // namespace taut::sim

/// ROW(name, type, how many, role, when halted, start): `start` is a function of start_values.h.
/// Snapshots and hashes have the order of this list.
// clang-format off
#define TAUT_STATE_ROWS(ROW) \
  ROW(time,           Number, kWorld,    kState,     kStays,    Zero)             /* [s] */ \
  ROW(last_step,      Number, kWorld,    kState,     kStays,    Zero)             /* [s] */ \
  ROW(pos,            V3,     kBody,     kState,     kGoesBack, CentreOfMass)     /* [m] */ \
  ROW(quat,           Q4,     kBody,     kState,     kGoesBack, PrincipalFrame)   /* q_WP */ \
  ROW(vel,            V3,     kBody,     kState,     kGoesBack, Velocity)         /* [m/s] */ \
  ROW(mom,            V3,     kBody,     kState,     kGoesBack, AngularMomentum)  /* about com, in W [kg m^2/s] */ \
  ROW(old_vel,        V3,     kBody,     kState,     kStays,    Velocity)         /* vel before the last step */ \
  ROW(old_spin,       V3,     kBody,     kState,     kZero,     Spin)             /* its angular velocity [rad/s] */ \
  ROW(held_torque,    V3,     kBody,     kState,     kZero,    Zero)             /* of contacts and stiff cables in the last step [N m]; 0 after a landing */ \
  ROW(rest,           Number, kCable,    kState,     kGoesBack, RestLength)       /* [m] */ \
  ROW(rest_rate,      Number, kCable,    kState,     kGoesBack, Zero)             /* [m/s] */ \
  ROW(wheel_angle,    Number, kWheel,    kState,     kGoesBack, WheelAngle)       /* from point to point about it, with turns [rad] */ \
  ROW(span_rest,      Number, kSpan,     kState,     kGoesBack, SpanRest)         /* [m] */ \
  ROW(span_tension,   Number, kSpan,     kState,     kZero,     SpanTension)      /* mean over the last step [N] */ \
  ROW(slip_place,     Number, kSlip,     kState,     kGoesBack, SlipPlace)        /* middle of a wheel's arc, on the wheel [rad] */ \
  ROW(slip_loss,      Number, kSlip,     kState,     kGoesBack, Zero)             /* energy that friction took [J] */ \
  ROW(slip_along,     Number, kSlip,     kState,     kGoesBack, NotHeld)          /* middle of a bend's arc, along its axis [m], or kNotHeld */ \
  ROW(touch_side,     Number, kTouchRod, kState,     kZero,     TouchSide)        /* of the rod, of a part of the cable that crosses it (cable_rods.inl) */ \
  ROW(bend,           Bend,   kBend,     kState,     kForgets,  NoBend)           /* see there */ \
  ROW(motor,          Motor,  kMotor,    kState,     kGoesBack, MotorAtRest) \
  ROW(orders,         Orders, kMotor,    kState,     kStays,    FollowTarget) \
  ROW(target,         Number, kCable,    kState,     kStays,    RestLength)       /* [m] */ \
  ROW(tension,        Number, kCable,    kState,     kZero,     Tension)          /* [N] */ \
  ROW(joint_angle,    Number, kJoint,    kState,     kGoesBack, Zero)             /* of hinges, with turns [rad] */ \
  ROW(joint_load,     Number, kJointRow, kState,     kZero,     Zero)             /* along a row [N] */ \
  ROW(motion_work,    Number, kMotion,   kState,     kGoesBack, Zero)             /* done on all else [J] */ \
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
  ROW(halted,         Number, kWorld,    kParameter, kStays,    Zero)             /* 1 if it stands still */ \
  ROW(mean_step,      Number, kWorld,    kReading,   kZero,     Zero)             /* step of which stiff cables show the means [s]; 0: of none */ \
  ROW(mean_elastic,   Number, kCable,    kReading,   kZero,     Zero)             /* of a stiff cable's spring over that step [N] */ \
  ROW(contact_key,    Number, kContact,  kMemory,    kForgets,  NoKey)            /* pair and feature; -1: none */ \
  ROW(contact_force,  V3,     kContact,  kMemory,    kStays,    Zero)             /* in W [N] */ \
  ROW(contact_slip,   Number, kContact,  kMemory,    kStays,    SlipUnknown)      /* 1 slid, 0 stuck */ \
  ROW(contact_arm,    V3,     kContact,  kDerived,   kStays,    Zero)             /* from body a, in W [m] */ \
  ROW(contact_normal, V3,     kContact,  kDerived,   kStays,    Zero)             /* in W */ \
  ROW(contact_gap,    Number, kContact,  kDerived,   kStays,    Zero)             /* [m] */ \
  ROW(joint_force,    V3,     kJoint,    kDerived,   kZero,     Zero)             /* on body b, in W [N] */ \
  ROW(joint_torque,   V3,     kJoint,    kDerived,   kZero,     Zero)             /* on b about its point [N m] */ \
  ROW(motion_force,   V3,     kMotion,   kDerived,   kZero,     Zero)             /* on its body, in W [N] */ \
  ROW(motion_torque,  V3,     kMotion,   kDerived,   kZero,     Zero)             /* on it, about its origin [N m] */ \
  ROW(clearance,      Number, kBodyPair, kDerived,   kStays,    Zero)             /* at least this far apart [m] */ \
  ROW(quiet_from,     V3,     kKept,     kDerived,   kStays,    Zero)             /* a rod's end when it was looked up [m] */ \
  ROW(quiet_to,       V3,     kKept,     kDerived,   kStays,    Zero)             /* its other end [m] */ \
  ROW(quiet_limit,    Number, kKept,     kDerived,   kStays,    Zero)             /* near there it has no contact within that [m]; 0: not known */ \
  ROW(touch_from,     V3,     kTouch,    kDerived,   kStays,    Zero)             /* where a free cable began when it was looked at [m] */ \
  ROW(touch_to,       V3,     kTouch,    kDerived,   kStays,    Zero)             /* and where it ended [m] */ \
  ROW(touch_free,     Number, kTouch,    kDerived,   kStays,    Zero)             /* then nothing was nearer [m]; 0: not known */ \
  ROW(residual,       Number, kWorld,    kDerived,   kStays,    Zero)             /* of the last solve [m/s] */ \
  ROW(linear_solves,  Number, kWorld,    kDerived,   kStays,    Zero)             /* of the last step */ \
  ROW(relaxation,        Number, kWorld,    kDerived,   kStays,    Zero)             /* by the last step's contacts, see WorldStatus [m/s] */ \
  ROW(sense_span_length, Number, kSpan,  kSensed,    kStays,    Zero)             /* [m] */ \
  ROW(sense_span_rest, Number, kSpan,    kSensed,    kStays,    Zero)             /* after what is still to slip [m] */ \
  ROW(sense_slip_loss, Number, kSlip,    kSensed,    kStays,    Zero)             /* with that [J] */ \
  ROW(sense_length,   Number, kCable,    kSensed,    kStays,    Zero)             /* [m] */ \
  ROW(sense_rate,     Number, kCable,    kSensed,    kStays,    Zero)             /* [m/s] */ \
  ROW(sense_tension,  Number, kCable,    kSensed,    kStays,    Zero)             /* [N] */ \
  ROW(sense_elastic,  Number, kCable,    kSensed,    kStays,    Zero)             /* [N] */
// clang-format on
