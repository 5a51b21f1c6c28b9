/// Runs every scene with full effort and writes the tables of docs/validation/mechanics.md to the
/// standard output. Exit status 1 if a value is not as expected.
///
///     mechanics_page [SUBJECT]

#include <cstdio>
#include <cstring>

#include "tests/mechanics/known_scene.h"

int main(int argc, char** argv) {
  using namespace taut::mechanics;
  const char* subject = "";
  int failed = 0;
  for (const SceneEntry& scene : AllScenes()) {
    if (argc > 1 && std::strcmp(argv[1], scene.subject) != 0) continue;
    if (std::strcmp(subject, scene.subject) != 0) {
      subject = scene.subject;
      std::printf("\n## %c%s\n", subject[0] - 'a' + 'A', subject + 1);
    }
    std::fprintf(stderr, "%s: %s\n", scene.subject, scene.name);
    Report report(Effort::kFull);
    scene.run(report);
    std::printf(
        "\n**%s** (reference: %s)\n\n| quantity | unit | expected | measured "
        "|\n|---|---|---|---|\n",
        scene.name, scene.oracle);
    for (const Finding& f : report.findings()) {
      char expected[80];
      if (f.is_bound) {
        std::snprintf(expected, sizeof expected, "at most %.4g", f.expected);
      } else {
        std::snprintf(expected, sizeof expected, "%.10g within %.2g", f.expected, f.tolerance);
      }
      std::printf("| %s | %s | %s | %s%.10g%s |\n", f.quantity.c_str(), f.unit.c_str(), expected,
                  f.Holds() ? "" : "**", f.measured, f.Holds() ? "" : "** (fails)");
      if (!f.Holds()) ++failed;
    }
    std::fflush(stdout);
  }
  return failed == 0 ? 0 : 1;
}
