// C interface of the browser demo for the page's worker (web/src/demo/core.ts). Returned texts are
// valid until the next call.
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "demo.h"

namespace {

taut::browser::Demo demo;
std::string answer;
std::shared_ptr<const std::string> frame;

const char* Return(std::string text) {
  answer = std::move(text);
  return answer.c_str();
}

/// Parses numbers separated by blanks.
std::vector<double> Numbers(const char* text) {
  std::vector<double> numbers;
  std::istringstream in(text);
  for (double number = 0; in >> number;) numbers.push_back(number);
  return numbers;
}

}  // namespace

extern "C" {

const char* taut_check(const char* path) { return Return(taut::browser::Demo::Check(path)); }

const char* taut_open(const char* path, const char* mark_at_s, int paused) {
  return Return(demo.Open(path, Numbers(mark_at_s), paused != 0));
}

const char* taut_post(const char* message) { return Return(demo.Post(message)); }

double taut_turn() { return demo.Turn(); }

const char* taut_messages() { return Return(demo.TakeMessages()); }

/// Returns the size of the newest frame in bytes; 0 if there is none since the last call.
const char* taut_frame() {
  frame = demo.TakeFrame();
  return frame ? frame->data() : nullptr;
}
int taut_frame_size() { return frame ? static_cast<int>(frame->size()) : 0; }

const char* taut_state() { return Return(demo.State()); }
}
