/// Tables and checksums of a study's log file.
#pragma once

#include <cstdint>
#include <string>

#include "learn/study_log.h"

namespace taut::learn {

/// Application id of the SQLite file: "taut" in ASCII.
inline constexpr std::int64_t kApplicationId = 0x74617574;

/// Returns the SQL text that creates the tables of a version.
std::string Schema(int version);

std::uint64_t Checksum(const Evaluation& evaluation);
/// Returns the checksum of facts and parameters.
std::uint64_t Checksum(const LogContents& contents);

/// Returns the text of the fact "evaluations": the number of evaluations and the sum of their
/// checksums.
std::string Tally(std::uint64_t count, std::uint64_t sum);

/// Creates the tables and inserts `contents`. Returns false after an error; see
/// `Database::TakeError`.
bool Insert(Database& database, const LogContents& contents);
/// Inserts an evaluation with its worlds, and updates the tally.
bool Insert(Database& database, const Evaluation& evaluation, const std::string& tally);

/// Reads a file with the tables of `version`. Invalid evaluations are listed in `damage`. Invalid
/// facts or parameters set `error`.
LogContents ReadRows(Database& database, int version, std::string& error);

}  // namespace taut::learn
