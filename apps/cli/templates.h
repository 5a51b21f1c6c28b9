/// Templates of model, experiment, gait, study and fit files, which run unchanged.
#pragma once

#include <string>

namespace taut::cli {

/// Each function returns the text of a template. `schema`: path of the format's JSON schema, for
/// editors; empty: none. `from`: the model of an experiment, the experiment of a study.
std::string NewModel(const std::string& name, const std::string& schema);
std::string NewExperiment(const std::string& name, const std::string& schema,
                          const std::string& from);
std::string NewStudy(const std::string& name, const std::string& schema, const std::string& from);

}  // namespace taut::cli
