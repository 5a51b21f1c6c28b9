/// The keys of a gait file, and what of them is in a resolved experiment. Those of each kind of
/// gait are in a file of its own (gait_kinds.h).
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
  io.Map("", "Gait file",
         "What moves a robot: signals to its cables, from sine waves, from a network of "
         "oscillators or from a table. A signal is a velocity V0 that impedance control adds, or a "
         "length that is added to a rest length (`drives`). An experiment plays a gait by a "
         "controller's `velocity_input` or `rest_length_input`; equations are in "
         "docs/theory/gaits.md.");
  HeadKeys(io, g,
           {"Name of the gait. Needed unless `base` has it.",
            "What the gait does and where it comes from, in a sentence or two.",
            "Another gait file, seen from this file's folder. This file then holds only what "
            "differs: each of its keys replaces the base's as a whole, except that `parameters` "
            "are merged by name.",
            R"("hand_tuned_sine.yaml")",
            "Named numbers for expressions in this file. They may refer to each other, in any "
            "order.",
            R"({"amplitude_m_per_s": 0.06})"});
  io("drives", g.drives, kDrives, kLater,
     "What the signals are, and with that the unit of amplitudes, offsets and tables. `velocity`: "
     "V0 of impedance control, in m/s. `rest_length`: what is added to rest lengths, in m.");
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
