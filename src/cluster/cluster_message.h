/// Serialization of candidates, trials and other work, for exchange between processes of the same
/// build on machines of the same kind.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "taut/learn.h"

namespace taut::cluster {

using Bytes = std::string;

Bytes Pack(std::span<const Evaluator::Candidate> candidates);
std::vector<Evaluator::Candidate> UnpackCandidates(const Bytes& bytes);

Bytes Pack(const std::vector<Evaluator::Trial>& trials);
std::vector<Evaluator::Trial> UnpackTrials(const Bytes& bytes);

Bytes PackTexts(std::span<const std::string> texts);
std::vector<std::string> UnpackTexts(const Bytes& bytes);

}  // namespace taut::cluster
