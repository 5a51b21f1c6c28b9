#include <sys/utsname.h>

#include <cstdio>
#include <ctime>
#include <fstream>

#include "base/brief.h"
#include "taut/run.h"
#include "taut/version.h"

namespace taut {
namespace {

/// Returns the processor's name on Linux; an empty string elsewhere.
std::string ProcessorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t colon = line.find(": ");
    return colon == std::string::npos ? "" : line.substr(colon + 2);
  }
  return {};
}

std::string MachineName() {
  utsname name{};
  if (uname(&name) != 0) return ProcessorName();
  const std::string system = std::string(name.sysname) + " " + name.release + " " + name.machine;
  const std::string processor = ProcessorName();  // empty on Linux for AArch64
  return processor.empty() ? system : system + ", " + processor;
}

std::string NowUtc() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

TraceMetadata RunMetadata(const ExperimentSpec& experiment) {
  char hash[32];
  std::snprintf(hash, sizeof(hash), "%016llx",
                static_cast<unsigned long long>(experiment.input_hash));
  return {{"taut_version", kVersion},
          {"experiment", experiment.name},
          {"model", experiment.robot.def.name},
          {"input_hash", hash},
          {"seed", std::to_string(experiment.seed)},
          {"step_s", base::Shortest(LongestStep(experiment))},
          {"duration_s", base::Shortest(experiment.duration_s)},
          {"started", NowUtc()},
          {"machine", MachineName()},
          {"compiler", __VERSION__}};
}

}  // namespace taut
