#include "cluster/message.h"

#include <cstring>
#include <type_traits>

namespace taut::cluster {
namespace {

class Writer {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void Put(T x) {
    const auto* first = reinterpret_cast<const char*>(&x);
    bytes.insert(bytes.end(), first, first + sizeof x);
  }
  void Put(const std::string& text) {
    Put(text.size());
    bytes.insert(bytes.end(), text.begin(), text.end());
  }
  template <class T>
  void Put(const std::vector<T>& items) {
    Put(items.size());
    for (const T& item : items) Put(item);
  }
  void Put(const RolloutResult& r) {
    Put(r.done);
    Put(r.score);
    Put(r.failed);
    for (const double x : {r.distance_m, r.along_m, r.energy_j, r.max_tension_n, r.tracking_n}) {
      Put(x);
    }
    Put(r.fell_s.has_value());
    Put(r.fell_s.value_or(0.0));
    Put(r.state_hash);
  }
  Bytes bytes;
};

/// Reads zeros behind the end.
class Reader {
 public:
  explicit Reader(const Bytes& bytes) : bytes_(bytes) {}

  template <class T>
  requires std::is_arithmetic_v<T>
  void Get(T& x) {
    x = T{};
    if (at_ + sizeof x > bytes_.size()) return;
    std::memcpy(&x, bytes_.data() + at_, sizeof x);
    at_ += sizeof x;
  }
  void Get(std::string& text) {
    const std::size_t size = Size();
    text.assign(bytes_.data() + at_, size);
    at_ += size;
  }
  template <class T>
  void Get(std::vector<T>& items) {
    items.resize(Size());
    for (T& item : items) Get(item);
  }
  void Get(RolloutResult& r) {
    Get(r.done);
    Get(r.score);
    Get(r.failed);
    for (double* x : {&r.distance_m, &r.along_m, &r.energy_j, &r.max_tension_n, &r.tracking_n}) {
      Get(*x);
    }
    bool fell = false;
    double fell_s = 0;
    Get(fell);
    Get(fell_s);
    if (fell) r.fell_s = fell_s;
    Get(r.state_hash);
  }

  /// Every item has a byte at least.
  std::size_t Size() {
    std::size_t size = 0;
    Get(size);
    return size > bytes_.size() - at_ ? 0 : size;
  }

 private:
  const Bytes& bytes_;
  std::size_t at_ = 0;
};

}  // namespace

Bytes Pack(std::span<const Evaluator::Candidate> candidates) {
  Writer out;
  out.Put(candidates.size());
  for (const Evaluator::Candidate& candidate : candidates) {
    out.Put(candidate.id);
    out.Put(candidate.values);
  }
  return std::move(out.bytes);
}

std::vector<Evaluator::Candidate> UnpackCandidates(const Bytes& bytes) {
  Reader in(bytes);
  std::vector<Evaluator::Candidate> candidates(in.Size());
  for (Evaluator::Candidate& candidate : candidates) {
    in.Get(candidate.id);
    in.Get(candidate.values);
  }
  return candidates;
}

Bytes Pack(const std::vector<Evaluator::Trial>& trials) {
  Writer out;
  out.Put(trials.size());
  for (const Evaluator::Trial& trial : trials) {
    out.Put(trial.done);
    out.Put(trial.score);
    out.Put(trial.failed);
    out.Put(trial.seeds);
    out.Put(trial.worlds);
  }
  return std::move(out.bytes);
}

std::vector<Evaluator::Trial> UnpackTrials(const Bytes& bytes) {
  Reader in(bytes);
  std::vector<Evaluator::Trial> trials(in.Size());
  for (Evaluator::Trial& trial : trials) {
    in.Get(trial.done);
    in.Get(trial.score);
    in.Get(trial.failed);
    in.Get(trial.seeds);
    in.Get(trial.worlds);
  }
  return trials;
}

}  // namespace taut::cluster
