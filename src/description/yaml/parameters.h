/// The `parameters:` block of a file and its `--set name=value` overrides.
#pragma once

#include <string>
#include <vector>

#include "description/yaml/expression.h"
#include "description/yaml/yaml_tree.h"
#include "taut/spec.h"

namespace taut::description {

/// A parameter as written.
struct ParameterText {
  std::string name;
  std::string expression;
  SourceRef at;
};

/// `--set` pairs, and who has used them: an experiment and its model share one set, and what
/// neither of them knows is an error.
class OverrideSet {
 public:
  explicit OverrideSet(const Overrides& overrides);

  /// One more, with the place in a file that it comes from.
  void Add(ParameterText parameter);

  /// Replaces the expressions of the parameters that are overridden. The last of several
  /// overrides of one name wins.
  void Apply(std::vector<ParameterText>& parameters);

  /// For when a file could not be read far enough to know its parameters.
  void Silence();

  /// What no `Apply` has used so far.
  std::vector<ParameterText> Unused() const;

  /// An error for every override that no `Apply` has used; `known` are the names to hint at.
  void ReportUnused(const std::vector<std::string>& known, Diagnostics& out) const;

 private:
  struct Item {
    ParameterText text;
    bool used = false;
  };
  std::vector<Item> items_;
};

/// The error for an override of a parameter that is not there.
void ReportUnknownParameter(const ParameterText& parameter, const std::vector<std::string>& known,
                            Diagnostics& out);

/// Reads a `parameters:` map. `block` may be null: no parameters.
std::vector<ParameterText> ReadParameters(const Value* block, Diagnostics& out);

/// `changes` on top of `base`: the same name replaces, a new name is added.
void MergeParameters(std::vector<ParameterText>& base, const std::vector<ParameterText>& changes);

/// Evaluates parameters, which may refer to each other in any order. One that cannot be
/// evaluated is complained about once and is NaN in the result.
NameTable ResolveParameters(const std::vector<ParameterText>& parameters, Diagnostics& out);

/// A warning for each parameter that neither the file (`used`) nor another parameter that it uses
/// refers to: who changes it changes nothing. Those that only a base file has are left out.
void WarnOfUnused(const std::vector<ParameterText>& parameters, NameSet used,
                  const std::vector<std::string>& files, Diagnostics& out);

}  // namespace taut::description
