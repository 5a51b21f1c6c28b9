/// Rejection of commands and readings that are not finite, with the cable's name in the message.
/// Such a value would stop a simulated world without explanation, and must not reach a real motor.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "taut/plant.h"

namespace taut::plant {

class FiniteCheck {
 public:
  /// Name and value of a number.
  using Named = std::pair<const char*, double>;

  FiniteCheck(const std::vector<CableDef>& cables, int lanes);

  /// Copies the commands of all lanes, for use by `PutBack`.
  void Keep(const Commands& commands);
  /// Replaces commands that are not finite, in the lanes `among`, by the copies and reports errors.
  /// `who`: subject and verb of the message. `time_s`: returns the time of a lane.
  void PutBack(const Commands& commands, Lanes among, const std::function<double(int)>& time_s,
               std::string_view who);
  /// Reports an error for each reading that is not finite and has no fault bit. Returns the lanes
  /// of `among` in which all readings are valid.
  Lanes WithReadings(const Observation& seen, Lanes among);
  /// Checks numbers that a program sets for an element, such as node "tip". Reports an error and
  /// returns false if one of them is not finite.
  bool Accepts(int lane, double time_s, const char* kind, const std::string& name,
               std::span<const Named> numbers);

  /// Returns a message about the first rejected number of a lane since its start; empty if there is
  /// none.
  const std::string& refused(int lane) const noexcept {
    return refused_[static_cast<std::size_t>(lane)];
  }
  void Restart(int lane) noexcept { refused_[static_cast<std::size_t>(lane)].clear(); }

 private:
  void Refuse(int lane, double time_s, std::string_view who, const char* kind,
              const std::string& name, const Named& number);
  /// Returns the name of the cable of entry `i` in a row.
  const std::string& CableAt(std::size_t i) const {
    return cables_[i / static_cast<std::size_t>(lanes_)].name;
  }

  const std::vector<CableDef>& cables_;
  int lanes_;
  std::vector<double> kept_;  ///< Copied rows of commands, one after the other.
  std::vector<std::string> refused_;
};

}  // namespace taut::plant
