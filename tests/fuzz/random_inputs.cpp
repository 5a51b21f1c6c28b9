#include "fuzz/random_inputs.h"

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <random>

#include "fuzz/fuzz_folder.h"
#include "math/random.h"

namespace taut::fuzz {
namespace {

/// Data of the failure handler, prepared before the target runs, because the handler must not
/// allocate.
struct Current {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
  std::array<char, 4096> path{};     ///< File for a failing input; empty: none.
  std::array<char, 8192> message{};  ///< Text for standard error.
  std::array<char, 128> count{};     ///< Text for standard output.
};
Current current;
volatile std::sig_atomic_t interrupted = 0;

void Say(int stream, const char* text) {
  std::size_t left = std::strlen(text);
  while (left > 0) {
    const ssize_t written = write(stream, text, left);
    if (written <= 0) return;
    text += written, left -= static_cast<std::size_t>(written);
  }
}

void Keep() {
  if (current.path[0] == 0) return;
  const int file = open(current.path.data(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const bool kept =
      file >= 0 && write(file, current.data, current.size) == static_cast<ssize_t>(current.size);
  if (!kept) Say(STDERR_FILENO, "it could not be kept\n");
}

extern "C" void FailedInput(int signal) {
  Say(STDERR_FILENO, signal == SIGPROF ? "\nhangs: " : "\nfails: ");
  Say(STDERR_FILENO, current.message.data());
  Keep();
  Say(STDOUT_FILENO, current.count.data());
  _exit(1);
}
extern "C" void Interrupt(int) { interrupted = 1; }

/// Failures end in FailedInput, on a separate stack: the target's stack may be full.
void CatchFailures() {
  static std::array<char, 1 << 16> stack;
  stack_t other{};
  other.ss_sp = stack.data();
  other.ss_size = stack.size();
  Must(sigaltstack(&other, nullptr) == 0, "a stack for signals");
  struct sigaction action {};
  action.sa_handler = FailedInput;
  action.sa_flags = SA_ONSTACK;
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGPROF}) {
    Must(sigaction(signal, &action, nullptr) == 0, "signals can be handled");
  }
}

template <std::size_t N, class... Values>
void Print(std::array<char, N>& to, const char* form, Values... values) {
  std::snprintf(to.data(), to.size(), form, values...);
}

/// Limits the processor time from now on, so that other load on the machine makes no input time
/// out. 0: no limit.
void Allow(unsigned seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

double ProcessorTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Exceptions terminate the program, as an abort does.
void TryOne(const std::vector<std::uint8_t>& input, unsigned timeout_s, Target target) noexcept {
  current.data = input.data();
  current.size = input.size();
  Allow(timeout_s);
  target(input.data(), input.size());
  Allow(0);
}

/// Source of the mutations of the current input, for `LLVMFuzzerMutate`, which has no seed.
std::mt19937 byte_mutations;

}  // namespace

std::size_t MutateBytes(std::uint8_t* data, std::size_t size, std::size_t max_size, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t n) { return n == 0 ? std::size_t{0} : random() % n; };
  const std::size_t at = below(size), count = 1 + below(std::min<std::size_t>(size - at, 16));
  switch (size == 0 ? 1 : random() % 4) {
    case 0:  // change
      data[at] =
          static_cast<std::uint8_t>(random() % 2 == 0 ? random() : data[at] ^ 1U << below(8));
      return size;
    case 1:  // insert
      if (size >= max_size) return size;
      std::memmove(data + at + 1, data + at, size - at);
      data[at] = static_cast<std::uint8_t>(random());
      return size + 1;
    case 2:  // remove
      if (size - at < count) return size;
      std::memmove(data + at, data + at + count, size - at - count);
      return size - count;
    default:  // copy over others
      if (size - at >= count) std::memmove(data + below(size - count + 1), data + at, count);
      return size;
  }
}

std::vector<std::uint8_t> MutatedInput(std::uint64_t seed, std::uint64_t index, const Inputs& bases,
                                       Mutator mutator) {
  math::Random random(seed, 1, index);
  std::vector<std::uint8_t> input = bases[random.Bits() % bases.size()];
  std::size_t size = input.size();
  input.resize(std::max(size, kMostMutated));
  byte_mutations.seed(static_cast<unsigned>(random.Bits()));
  for (std::uint64_t i = 0, count = 1 + random.Bits() % 4; i < count; ++i) {
    size = mutator(input.data(), size, input.size(), static_cast<unsigned>(random.Bits()));
  }
  input.resize(size);
  return input;
}

std::vector<std::uint8_t> RandomInput(std::uint64_t seed, std::uint64_t index) {
  math::Random random(seed, 0, index);
  std::vector<std::uint8_t> input(1 + random.Bits() % 256);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < input.size(); ++i, bits >>= 8) {
    if (i % 8 == 0) bits = random.Bits();
    input[i] = static_cast<std::uint8_t>(bits);
  }
  return input;
}

int TryRandomInputs(const Campaign& campaign, Target target) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto elapsed_s = [&] {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const auto seed = static_cast<unsigned long long>(campaign.seed);
  CatchFailures();
  interrupted = 0;
  std::signal(SIGINT, Interrupt);
  std::signal(SIGTERM, Interrupt);
  const double every_s = isatty(STDERR_FILENO) == 1 ? 1 : 60;
  double shown_s = 0, slowest_s = 0;
  long tried = 0, slowest = 0;
  while (tried < campaign.count && interrupted == 0) {
    const double now_s = elapsed_s();
    if (campaign.seconds > 0 && now_s >= campaign.seconds) break;
    if (campaign.shows_progress && now_s - shown_s >= every_s) {
      shown_s = now_s;
      std::fprintf(stderr, every_s < 60 ? "\r%ld inputs in %.0f s" : "%ld inputs in %.0f s\n",
                   tried, now_s);
    }
    const long index = campaign.first + tried++;
    if (!campaign.found_prefix.empty()) {
      Print(current.path, "%s%llu-%ld", campaign.found_prefix.c_str(), seed, index);
    }
    Print(current.message,
          "input %ld of seed %llu; again: --seed %llu --first %ld --inputs 1%s%s\n", index, seed,
          seed, index, current.path[0] != 0 ? "; kept as " : "", current.path.data());
    Print(current.count, "stat::number_of_executed_units: %ld\n", tried);  // libFuzzer's format
    const auto number = static_cast<std::uint64_t>(index);
    const std::vector<std::uint8_t> input =
        campaign.bases.empty()
            ? RandomInput(campaign.seed, number)
            : MutatedInput(campaign.seed, number, campaign.bases, campaign.mutator);
    const double before_s = ProcessorTime();
    TryOne(input, campaign.timeout_s, target);
    if (const double took_s = ProcessorTime() - before_s; took_s > slowest_s) {
      slowest_s = took_s, slowest = index;
    }
  }
  if (campaign.shows_progress) {
    std::fprintf(stderr, "slowest input: %ld, %.3f s of processor time\n", slowest, slowest_s);
  }
  if (shown_s > 0 && every_s < 60) std::fprintf(stderr, "\n");
  std::printf("stat::number_of_executed_units: %ld\n", tried);
  std::fflush(stdout);
  return interrupted != 0 ? 130 : 0;
}

void TryFile(const std::string& path, unsigned timeout_s, Target target) {
  CatchFailures();
  const std::string text = ReadAll(path);
  const std::vector<std::uint8_t> input(text.begin(), text.end());
  Print(current.message, "%s\n", path.c_str());
  TryOne(input, timeout_s, target);
}

}  // namespace taut::fuzz

/// Replaces libFuzzer's function of this name, which custom mutators call.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t max_size) {
  const auto seed = static_cast<unsigned>(taut::fuzz::byte_mutations());
  return taut::fuzz::MutateBytes(data, size, max_size, seed);
}
