/// Parameters of a file (`parameters:`) and their `--set name=value` overrides.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/expression.h"
#include "description/yaml/yaml_tree.h"
#include "taut/spec.h"

namespace taut::description {

/// Parameter as in the file.
struct ParameterText {
  std::string name;
  std::string expression;
  SourceRef at;
};

/// `--set` overrides and their use. An experiment and its model share one set. An override is an
/// error if neither the experiment nor the model has the parameter.
class OverrideSet {
 public:
  explicit OverrideSet(const Overrides& overrides);

  /// Adds an override from a file. `parameter.at`: its position in that file.
  void Add(ParameterText parameter);

  /// Replaces the expressions of overridden parameters. If a name has several overrides, the last
  /// one counts.
  void Apply(std::vector<ParameterText>& parameters);

  /// Marks all overrides as used. For files with read errors, whose parameters are not fully known.
  void Silence();

  /// Returns the overrides that no `Apply` has used.
  std::vector<ParameterText> Unused() const;

  /// Reports an error for every override that no `Apply` has used. `known`: names for hints.
  void ReportUnused(const std::vector<std::string>& known, Diagnostics& out) const;

 private:
  struct Item {
    ParameterText text;
    bool used = false;
  };
  std::vector<Item> items_;
};

/// Reports an override of a parameter that does not exist.
void ReportUnknownParameter(const ParameterText& parameter, const std::vector<std::string>& known,
                            Diagnostics& out);

/// Reads a `parameters:` map. `block` may be null: no parameters.
std::vector<ParameterText> ReadParameters(const Value* block, Diagnostics& out);

/// Merges `changes` into `base`: replaces parameters with equal names and adds new parameters.
void MergeParameters(std::vector<ParameterText>& base, const std::vector<ParameterText>& changes);

/// Evaluates parameters, which may refer to each other in any order. Reports each parameter that
/// cannot be evaluated and sets it to NaN.
NameTable ResolveParameters(const std::vector<ParameterText>& parameters, Diagnostics& out);

/// Warns of parameters without effect: neither the file (`used`) nor a used parameter refers to
/// them. Parameters of base files are excluded.
void WarnOfUnused(const std::vector<ParameterText>& parameters, NameSet used,
                  const std::vector<std::string>& files, Diagnostics& out);

}  // namespace taut::description
