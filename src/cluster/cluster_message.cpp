#include "cluster/cluster_message.h"

#include "base/bytes.h"

namespace taut::cluster {
namespace {

using base::ByteReader;
using base::ByteWriter;

void Put(ByteWriter& out, const RolloutResult& r) {
  out.Put(r.done);
  out.Put(r.score);
  out.Put(r.failed);
  for (const double x : {r.distance_m, r.along_m, r.energy_j, r.max_tension_n, r.tracking_n}) {
    out.Put(x);
  }
  out.Put(r.fell_s.has_value());
  out.Put(r.fell_s.value_or(0.0));
  out.Put(r.state_hash);
}

void Get(ByteReader& in, RolloutResult& r) {
  in.Get(r.done);
  in.Get(r.score);
  in.Get(r.failed);
  for (double* x : {&r.distance_m, &r.along_m, &r.energy_j, &r.max_tension_n, &r.tracking_n}) {
    in.Get(*x);
  }
  bool fell = false;
  double fell_s = 0;
  in.Get(fell);
  in.Get(fell_s);
  if (fell) r.fell_s = fell_s;
  in.Get(r.state_hash);
}

}  // namespace

Bytes Pack(std::span<const Evaluator::Candidate> candidates) {
  ByteWriter out;
  out.Put(candidates.size());
  for (const Evaluator::Candidate& candidate : candidates) {
    out.Put(candidate.id);
    out.Put(candidate.values);
  }
  return std::move(out.bytes);
}

std::vector<Evaluator::Candidate> UnpackCandidates(const Bytes& bytes) {
  ByteReader in(bytes);
  std::vector<Evaluator::Candidate> candidates(in.Size());
  for (Evaluator::Candidate& candidate : candidates) {
    in.Get(candidate.id);
    in.Get(candidate.values);
  }
  return candidates;
}

Bytes Pack(const std::vector<Evaluator::Trial>& trials) {
  ByteWriter out;
  out.Put(trials.size());
  for (const Evaluator::Trial& trial : trials) {
    out.Put(trial.done);
    out.Put(trial.score);
    out.Put(trial.failed);
    out.Put(trial.seeds);
    out.Put(trial.worlds.size());
    for (const RolloutResult& world : trial.worlds) Put(out, world);
  }
  return std::move(out.bytes);
}

std::vector<Evaluator::Trial> UnpackTrials(const Bytes& bytes) {
  ByteReader in(bytes);
  std::vector<Evaluator::Trial> trials(in.Size());
  for (Evaluator::Trial& trial : trials) {
    in.Get(trial.done);
    in.Get(trial.score);
    in.Get(trial.failed);
    in.Get(trial.seeds);
    trial.worlds.resize(in.Size());
    for (RolloutResult& world : trial.worlds) Get(in, world);
  }
  return trials;
}

Bytes PackTexts(std::span<const std::string> texts) {
  ByteWriter out;
  out.Put(texts.size());
  for (const std::string& text : texts) out.Put(text);
  return std::move(out.bytes);
}

std::vector<std::string> UnpackTexts(const Bytes& bytes) {
  ByteReader in(bytes);
  std::vector<std::string> texts;
  in.Get(texts);
  return texts;
}

}  // namespace taut::cluster
