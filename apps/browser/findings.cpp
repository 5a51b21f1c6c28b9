#include "findings.h"

namespace taut::browser {
namespace {

void Add(const std::vector<Diagnostic>& diagnostics, bool error, viewer::Json& findings) {
  for (const Diagnostic& each : Sorted(diagnostics)) {
    findings.push_back({{"file", each.at.file},
                        {"line", each.at.line},
                        {"column", each.at.column},
                        {"error", error},
                        {"what", each.what},
                        {"hint", each.hint}});
  }
}

}  // namespace

viewer::Json FindingsOf(const Diagnostics& found) {
  viewer::Json findings = viewer::Json::array();
  Add(found.items(), true, findings);
  Add(found.warnings(), false, findings);
  return findings;
}

}  // namespace taut::browser
