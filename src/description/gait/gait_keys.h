/// Keys of gait files, with the subset that resolved experiments contain. Each kind of gait has its
/// keys in a separate file (gait_kinds.h).
#pragma once

#include "description/gait/gait_kinds.h"
#include "description/yaml/head_keys.h"
#include "description/yaml/keys.h"

namespace taut::description {

inline const Choices<GaitDrives> kDrives{{"velocity", GaitDrives::kVelocity},
                                         {"rest_length", GaitDrives::kRestLength}};

struct GaitForm {
  static constexpr const char* kSchema = R"("const": "gait")";
};
struct GaitText : GaitSpec {
  Head<GaitForm> head;
  GaitKindTexts texts;
};
template <class Io, Either<GaitSpec, GaitText> Gait>
void Keys(Io& io, Gait& g) {
  io.Map(
      "", "Gait file",
      "A gait file defines one signal per cable of a robot, computed by sine waves, a network of "
      "oscillators or a law for rolling, or read from a table. The key `drives` selects whether a "
      "signal is a velocity added to V0 of impedance control, or a "
      "length added to the rest length. Experiments use a gait as a controller's "
      "`velocity_input` or `rest_length_input`. Equations: docs/theory/gaits.md.");
  HeadKeys(io, g,
           {"Name of the gait. Required unless the `base` file has it.",
            "Purpose and origin of the gait, in a sentence or two.",
            "Another gait file to inherit from, relative to this file's folder. Each key of this "
            "file replaces the whole key of the base, except that `parameters` are merged by name.",
            R"("hand_tuned_sine.yaml")",
            "Named numbers for expressions in this file. Parameters may refer to each other, in "
            "any order.",
            R"({"amplitude_m_per_s": 0.06})"});
  io("drives", g.drives, kDrives, kLater,
     "Driven quantity, which sets the unit of amplitudes, offsets and tables. `velocity`: V0 of "
     "impedance control, in m/s. `rest_length`: change of rest length, in m.");
  io.SpeltBy("drives", {static_cast<int>(g.drives), WhoDrives(g.drives)});
  io.OneOf(GaitKindNames());
  ForEachGaitKind([&](const auto& kind, auto number) {
    if constexpr (Io::kResolved) {
      io(kind.name, g.*kind.gait);
    } else {
      io(kind.name, std::get<number()>(g.texts));
    }
  });
}

}  // namespace taut::description
