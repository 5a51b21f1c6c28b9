/// Parameters of a file (`parameters:`) and their `--set name=value` overrides.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/expression.h"
#include "description/yaml/yaml_tree.h"
#include "taut/spec.h"

namespace taut::description {

/// Parameter as written in the file.
struct ParameterText {
  std::string name;
  std::string expression;
  SourceRef at;
};

/// `--set` overrides and whether they have been used. An experiment and its model share one set; a
/// name that neither of them has is an error.
class OverrideSet {
 public:
  explicit OverrideSet(const Overrides& overrides);

  /// Adds an override that comes from a file; `parameter.at` is its place there.
  void Add(ParameterText parameter);

  /// Replaces the expressions of overridden parameters. The last of several overrides of one name
  /// wins.
  void Apply(std::vector<ParameterText>& parameters);

  /// Marks all overrides as used: after a read error the parameters of a file are not all known.
  void Silence();

  /// Returns the overrides that no `Apply` has used.
  std::vector<ParameterText> Unused() const;

  /// Reports an error for every override that no `Apply` has used; `known` are the names for hints.
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

/// Merges `changes` into `base`: the same name replaces, a new name is added.
void MergeParameters(std::vector<ParameterText>& base, const std::vector<ParameterText>& changes);

/// Evaluates parameters, which may refer to each other in any order. A parameter that cannot be
/// evaluated is reported once and is NaN in the result.
NameTable ResolveParameters(const std::vector<ParameterText>& parameters, Diagnostics& out);

/// Warns of each parameter to which neither the file (`used`) nor another parameter in use refers,
/// because a change of it has no effect. Parameters that only a base file defines are left out.
void WarnOfUnused(const std::vector<ParameterText>& parameters, NameSet used,
                  const std::vector<std::string>& files, Diagnostics& out);

}  // namespace taut::description
