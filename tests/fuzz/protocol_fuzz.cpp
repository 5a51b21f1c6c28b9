// Fuzz target of messages from a browser, one per line: a message is refused with a reason, or
// becomes a command whose numbers are in their ranges. All commands go to a live run, which must
// still answer after them.
#include <cmath>
#include <nlohmann/json.hpp>
#include <semaphore>
#include <sstream>

#include "apps/viewer/live_session.h"
#include "fuzz/fuzz_folder.h"
#include "taut/spec.h"

namespace {

using taut::fuzz::Must;
using taut::viewer::Command;
using taut::viewer::LiveOptions;
using taut::viewer::LiveSession;

const std::string kExperiment = TAUT_SOURCE_DIR "/share/experiments/hang.yaml";
constexpr int kMaxMessages = 100;       // a session keeps at most 256 questions
constexpr int kClient = 1, kAsker = 2;  // kAsker receives only the answer to its single question

taut::ExperimentSpec Experiment() {
  taut::Diagnostics out;
  auto experiment = taut::LoadExperiment(kExperiment, {}, out);
  Must(experiment.has_value(), out.Format());
  return *experiment;
}

void CheckCommand(const Command& command) {
  const auto& v = command.vector;
  for (const double x : {command.value, command.t0, command.t1, v.x, v.y, v.z}) {
    Must(std::isfinite(x), "numbers of a message are finite");
  }
  Must(std::abs(command.count) <= 1000, "steps have a bound");
  Must(command.type != "push" || command.value > 0, "a push lasts for a time");
  Must(command.type != "speed" || command.value >= 0, "time goes on");
}

/// Returns true once kAsker received its answer. All output must be valid messages.
bool Answered(LiveSession& session) {
  bool answered = false;
  for (const taut::viewer::Outgoing& message : session.TakeMessages()) {
    const auto json = nlohmann::json::parse(message.text, nullptr, false);
    Must(json.is_object() && json.contains("type"), "not a message: " + message.text);
    answered = answered || message.client == kAsker;
  }
  return answered;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const taut::ExperimentSpec experiment = Experiment();
  std::istringstream lines(std::string(data, data + size));
  LiveOptions options;
  options.inputs.path = kExperiment;
  options.paused = true;
  taut::Diagnostics out;
  const auto session = LiveSession::Create("live", experiment, options, out);
  Must(session != nullptr, out.Format());
  std::counting_semaphore<> bell{0};
  session->Start([&] { bell.release(); });
  std::string line, error;
  for (int i = 0; i < kMaxMessages && std::getline(lines, line); ++i) {
    error.clear();
    const auto command = taut::viewer::ParseCommand(line, error);
    Must(command.has_value() == error.empty(), "a command or a reason: " + line);
    if (!command) continue;
    CheckCommand(*command);
    Must(session->Post(kClient, *command), "there is room for a command");
  }
  Command question;
  question.type = "want_series";
  question.name = "none";
  question.points = 2;
  Must(session->Post(kAsker, question), "there is room for a question");
  while (!Answered(*session)) bell.acquire();
  session->Stop();
  return 0;
}
