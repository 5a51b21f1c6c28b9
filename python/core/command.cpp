// `taut._core.main`: the command `taut` inside the module, for wheels.
#include <string>
#include <vector>

#include "apps/cli/command_main.h"
#include "taut/shipped.h"
#include "text.h"

namespace taut::python {

void AddCommand(py::module_& module) {
  module.def(
      "main",
      [](const std::string& place, const std::vector<std::string>& arguments) {
        SetRunningProgram(place);
        std::vector<std::string> words{"taut"};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        // The command owns the process: it handles signals itself and needs no interpreter.
        const Released others;
        return cli::Main(static_cast<int>(words.size()), argv.data());
      },
      py::arg("place"), py::arg("arguments"),
      "Runs the command `taut` with these arguments; returns its exit status. `place`: path of "
      "this module; the shipped files are in its folder.");
}

}  // namespace taut::python
