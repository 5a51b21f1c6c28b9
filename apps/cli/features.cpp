// Optional features of a build, for bug reports and installations on clusters: MPI, the viewer's
// pages, instruction sets, static linking, assertions.
#include "features.h"

#include <fmt/format.h>

#include <string_view>

#include "apps/viewer/web_files.h"
#include "qr_code.h"
#include "taut/instruction_sets.h"

namespace taut::cli {
namespace {

std::string Line(std::string_view name, bool has, std::string_view fix) {
  return has ? fmt::format("{}: yes\n", name) : fmt::format("{}: no ({})\n", name, fix);
}

}  // namespace

std::string FeaturesText() {
#ifdef TAUT_FEATURE_MPI
  constexpr bool kMpi = true;
#else
  constexpr bool kMpi = false;
#endif
#ifdef TAUT_FEATURE_STATIC
  constexpr bool kStatic = true;
#else
  constexpr bool kStatic = false;
#endif
#ifdef TAUT_ASSERTS
  constexpr bool kAsserts = true;
#else
  constexpr bool kAsserts = false;
#endif
  std::string text =
      Line("MPI", kMpi, "install libopenmpi-dev and openmpi-bin, then build from source");
  std::string missing;
  text += Line("viewer's pages", viewer::FindWebFolder(missing).has_value(),
               "install nodejs and npm, then build from source; or set TAUT_WEB to the "
               "pages' folder");
  text += Line("QR codes", HasQrCodes(), "install libqrcodegencpp-dev, then build from source");
  for (const InstructionSet& set : InstructionSets()) {
    if (set.name == "simd128") continue;  // only for browsers
    const std::string line = fmt::format("instruction set {}", set.name);
    if (set.is_built && !set.runs_here) {
      text += fmt::format("{}: yes, but this processor lacks it\n", line);
    } else {
      text += Line(line, set.is_built,
                   set.name == "neon" ? "build for AArch64"
                                      : "build for x86-64 and add it to -DTAUT_INSTRUCTION_SETS");
    }
  }
  text += Line("static libraries", kStatic, "build with script/portable");
  text += Line("assertions", kAsserts, "build with -DTAUT_ASSERTS=ON");
  return text;
}

}  // namespace taut::cli
