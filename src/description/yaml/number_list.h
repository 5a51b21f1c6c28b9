/// List of all numbers of a struct, collected from its table of keys (keys.h), for studies.
#pragma once

#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "base/name_unit.h"
#include "description/yaml/read_keys.h"

namespace taut::description {

/// Collects every number that is present and not `kFixed`. Its name is "prefix.key"; items of lists
/// are identified by their names. `Number` is an aggregate of name, unit, pointer to the field,
/// lower and upper bound. Angles without bounds have the range -pi to pi.
template <class Number>
class NumberList : public KeyVisitor<NumberList<Number>, true> {
 public:
  explicit NumberList(std::string prefix) : prefix_(std::move(prefix)) {}

  template <class T>
  void On(const Key& key, T& field) {
    if constexpr (std::same_as<T, double>) {
      Add(key, key.name, field);
    } else if constexpr (kIsOptional<T>) {
      if (field) On(key, *field);
    } else if constexpr (std::same_as<T, std::vector<double>>) {
      for (std::size_t i = 0; key.varied && i < field.size(); ++i) {
        Add(key, key.name + ("_" + std::to_string(i + 1)), field[i]);
      }
    } else if constexpr (kIsList<T>) {
      for (auto& item : field) {
        if constexpr (requires { item.name; }) Inside(item.name, item);
      }
    } else if constexpr (requires { Keys(*this, field); }) {
      Inside(key.name, field);
    }
  }
  template <class E>
  void On(const Key&, E&, const Choices<E>&) {}

  std::vector<Number> numbers;

 private:
  void Add(const Key& key, const std::string& name, double& field) {
    if (key.fixed) return;
    const std::string unit = base::UnitAtEnd(key.name).Text();
    double least = key.bound->least, most = key.bound->most;
    if (unit == "rad" && std::isinf(least) && std::isinf(most))
      least = -std::numbers::pi, most = std::numbers::pi;
    Number& number = numbers.emplace_back(Number{prefix_ + name, unit, &field, least, most});
    if constexpr (requires { number.at_start; }) number.at_start = key.at_start;
  }
  template <class T>
  void Inside(const std::string& name, T& field) {
    NumberList inner(prefix_ + name + ".");
    inner.spelling = this->spelling;
    Keys(inner, field);
    numbers.insert(numbers.end(), inner.numbers.begin(), inner.numbers.end());
  }

  std::string prefix_;
};

}  // namespace taut::description
