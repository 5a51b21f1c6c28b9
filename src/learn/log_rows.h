/// How a study's log is laid out, and what is checked of it.
#pragma once

#include <cstdint>
#include <string>

#include "learn/log.h"

namespace taut::learn {

/// What makes a file one of ours, beside its tables: "taut" in ASCII.
inline constexpr std::int64_t kApplicationId = 0x74617574;

/// The tables of a version.
std::string Schema(int version);

std::uint64_t Checksum(const Evaluation& evaluation);
/// Of facts and parameters.
std::uint64_t Checksum(const LogContents& contents);

/// The fact "evaluations": how many there are, and the sum of their checksums.
std::string Tally(std::uint64_t count, std::uint64_t sum);

/// Empty tables become `contents`. False: see the database's error.
bool Insert(Database& database, const LogContents& contents);
/// Adds one, with its worlds and the new tally.
bool Insert(Database& database, const Evaluation& evaluation, const std::string& tally);

/// Everything in a file of `version`, whose tables are ours. What cannot be used is in `damage`,
/// or, if it is facts or parameters, in `error`.
LogContents ReadRows(Database& database, int version, std::string& error);

}  // namespace taut::learn
