// Command `taut schema`: JSON schemas of the file formats.
#include "taut/schema.h"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "commands.h"
#include "overrides.h"

namespace taut::cli {

void AddSchema(CLI::App& app, int& exit_code) {
  auto format = std::make_shared<std::string>();
  CLI::App* schema =
      app.add_subcommand("schema", "Print the JSON schema of a file format, for editors.");
  schema
      ->add_option("format", *format,
                   "model, experiment, gait, study, fit, faults, calibration or "
                   "catalogue")
      ->required()
      ->option_text(Alternatives(FormatNames()))
      ->check(OneOf(FormatNames()));
  schema->footer(
      "Examples:\n"
      "  taut schema model > model.schema.json\n"
      "The schema lists all keys with types, ranges, units, defaults and meanings. Editors "
      "complete and\n"
      "check a file whose first line is `# yaml-language-server: $schema=model.schema.json`.");
  schema->callback([format, &exit_code] {
    fmt::print("{}", *FormatSchema(*format));
    exit_code = kOk;
  });
}

}  // namespace taut::cli
