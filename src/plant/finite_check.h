/// Refusal of commands and readings that are not finite, with the name of the cable. Such a number
/// would halt a simulated world without a reason, and must not reach a motor.
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
  /// A number with its name.
  using Named = std::pair<const char*, double>;

  FiniteCheck(const std::vector<CableDef>& cables, int lanes);

  /// Copies the commands of all lanes, for `PutBack`.
  void Keep(const Commands& commands);
  /// Refuses commands that are not finite in the lanes `among`: puts the copies back. `who` sets
  /// them: subject and verb of the message. `time_s` returns the time of a lane.
  void PutBack(const Commands& commands, Lanes among, const std::function<double(int)>& time_s,
               std::string_view who);
  /// Reports an error for each reading that is not finite, unless its fault bit is set. Returns the
  /// lanes of `among` in which no reading was refused.
  Lanes WithReadings(const Observation& seen, Lanes among);
  /// Refuses numbers that a program sets for an element ("node", "tip") if one of them is not
  /// finite. Returns whether all are finite.
  bool Accepts(int lane, double time_s, const char* kind, const std::string& name,
               std::span<const Named> numbers);

  /// Returns a sentence about the first refused number of a lane since its start; empty: none.
  const std::string& refused(int lane) const noexcept {
    return refused_[static_cast<std::size_t>(lane)];
  }
  void Restart(int lane) noexcept { refused_[static_cast<std::size_t>(lane)].clear(); }

 private:
  void Refuse(int lane, double time_s, std::string_view who, const char* kind,
              const std::string& name, const Named& number);
  /// Returns the name of the cable with the entry `i` of a row.
  const std::string& CableAt(std::size_t i) const {
    return cables_[i / static_cast<std::size_t>(lanes_)].name;
  }

  const std::vector<CableDef>& cables_;
  int lanes_;
  std::vector<double> kept_;  ///< Rows of commands, one after the other.
  std::vector<std::string> refused_;
};

}  // namespace taut::plant
