/// Candidates and trials as bytes, between processes of one build on one kind of machine.
#pragma once

#include <span>
#include <vector>

#include "taut/learn.h"

namespace taut::cluster {

using Bytes = std::vector<char>;

Bytes Pack(std::span<const Evaluator::Candidate> candidates);
std::vector<Evaluator::Candidate> UnpackCandidates(const Bytes& bytes);

Bytes Pack(const std::vector<Evaluator::Trial>& trials);
std::vector<Evaluator::Trial> UnpackTrials(const Bytes& bytes);

}  // namespace taut::cluster
