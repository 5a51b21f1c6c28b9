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
      app.add_subcommand("schema", "Print what a kind of file may hold, for editors.");
  schema
      ->add_option("format", *format,
                   "model, experiment, gait, study, fit, faults, calibration or "
                   "catalogue")
      ->required()
      ->option_text(Alternatives(FormatNames()))
      ->check(OneOf(FormatNames()));
  schema->footer(
      "Example:\n"
      "  taut schema model > model.schema.json\n"
      "A JSON schema with all keys, their types, ranges, units, defaults and meanings. A file "
      "whose\n"
      "first line is `# yaml-language-server: $schema=model.schema.json` is completed and checked\n"
      "while typing.");
  schema->callback([format, &exit_code] {
    fmt::print("{}", *FormatSchema(*format));
    exit_code = kOk;
  });
}

}  // namespace taut::cli
