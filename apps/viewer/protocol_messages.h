/// Generated from web/protocol/messages.json by script/protocol. Do not edit.
#pragma once

namespace taut::viewer {

inline constexpr int kProtocolVersion = 10;

/// JSON type of a message's field.
enum class FieldKind { kString, kNumber, kInteger, kBoolean, kVec3, kChoice };

struct MessageField {
  const char* message;
  const char* name;  ///< Empty: the message has no fields.
  FieldKind kind;
  bool optional;
  const char* choices;  ///< kChoice: "a|b".
};

/// Fields of all messages from clients.
// clang-format off
inline constexpr MessageField kClientFields[] = {
    {"take_control", "", FieldKind::kString, true, ""},
    {"pause", "", FieldKind::kString, true, ""},
    {"resume", "", FieldKind::kString, true, ""},
    {"step", "count", FieldKind::kInteger, true, ""},
    {"reset", "", FieldKind::kString, true, ""},
    {"speed", "factor", FieldKind::kNumber, false, ""},
    {"seek", "time_s", FieldKind::kNumber, false, ""},
    {"drag", "node", FieldKind::kString, false, ""},
    {"drag", "target_m", FieldKind::kVec3, false, ""},
    {"drop", "", FieldKind::kString, true, ""},
    {"push", "node", FieldKind::kString, false, ""},
    {"push", "force_n", FieldKind::kVec3, false, ""},
    {"push", "duration_s", FieldKind::kNumber, false, ""},
    {"set_parameter", "name", FieldKind::kString, false, ""},
    {"set_parameter", "value", FieldKind::kNumber, false, ""},
    {"set_setpoint", "cable", FieldKind::kString, false, ""},
    {"set_setpoint", "value", FieldKind::kNumber, false, ""},
    {"set_gain", "cable", FieldKind::kString, false, ""},
    {"set_gain", "gain", FieldKind::kChoice, false, "length_offset_m|position_gain_n_per_m|velocity_gain_n_s_per_m"},
    {"set_gain", "value", FieldKind::kNumber, false, ""},
    {"start", "as", FieldKind::kChoice, false, "described|dropped|settled"},
    {"analyze", "", FieldKind::kString, true, ""},
    {"open_shape", "number", FieldKind::kInteger, false, ""},
    {"stop", "", FieldKind::kString, true, ""},
    {"robot_mode", "mode", FieldKind::kChoice, false, "off|arm|hold|impedance|clear_faults"},
    {"robot_gain", "cable", FieldKind::kString, false, ""},
    {"robot_gain", "gain", FieldKind::kChoice, false, "tension_offset_n|length_offset_m|position_gain_n_per_m|velocity_gain_n_s_per_m"},
    {"robot_gain", "value", FieldKind::kNumber, false, ""},
    {"record", "on", FieldKind::kBoolean, false, ""},
    {"want_series", "id", FieldKind::kInteger, false, ""},
    {"want_series", "channel", FieldKind::kString, false, ""},
    {"want_series", "source", FieldKind::kInteger, true, ""},
    {"want_series", "t0", FieldKind::kNumber, false, ""},
    {"want_series", "t1", FieldKind::kNumber, false, ""},
    {"want_series", "points", FieldKind::kInteger, false, ""},
};
// clang-format on

/// Numbers of a frame's header, in their order.
enum FrameHeader {
  kFrameTimeS,
  kFrameNowS,
  kFrameRealTimeFactor,
  kFrameSpeed,
  kFramePaused,
  kFrameDriver,
  kFrameKineticJ,
  kFrameGravityJ,
  kFrameElasticJ,
  kFrameRun,
  kFrameBodyCount,
  kFrameCableCount,
  kFrameContactCount,
  kFrameContactRows,
  kFramePushCount,
  kFrameValueCount,
  kFrameGhostCount,
  kFrameBendCount,
  kFrameSpanCount,
  kFrameHeaderSize,
};
inline constexpr int kFrameBodiesValues = 7;
inline constexpr int kFrameCablesValues = 4;
inline constexpr int kFrameContactsValues = 6;
inline constexpr int kFramePushesValues = 4;
inline constexpr int kFrameValuesValues = 1;
inline constexpr int kFrameGhostsValues = 7;
inline constexpr int kFrameBendsValues = 4;
inline constexpr int kFrameSpansValues = 2;

}  // namespace taut::viewer
