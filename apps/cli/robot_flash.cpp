// `taut robot flash`: writes firmware and identity into a board with avrdude.
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "output.h"
#include "overrides.h"
#include "robot_console.h"
#include "taut/shipped.h"

namespace taut::cli {
namespace {

namespace fs = std::filesystem;

struct FlashArguments {
  std::string port = "/dev/ttyUSB0", hex, programmer = "arduino";
  int board = -1, baud = 57'600;
  bool fuses = false, keep_identity = false, dry_run = false;
};

/// Returns the path of the firmware: `--hex`, or else the file of the installed taut or of the
/// build tree.
std::string HexPath(const FlashArguments& args) {
  if (!args.hex.empty()) return args.hex;
  return FindBesideProgram("firmware/taut_board.hex").value_or("");
}

std::vector<std::string> Words(const FlashArguments& args, const std::string& hex) {
  std::vector<std::string> words{"avrdude",       "-p", "atmega328p", "-c",
                                 args.programmer, "-P", args.port};
  if (args.programmer == "arduino") words.insert(words.end(), {"-b", std::to_string(args.baud)});
  // The identity is written last: a chip without identity never powers a motor.
  if (args.fuses) words.insert(words.end(), {"-U", "efuse:w:0xFC:m"});
  words.insert(words.end(), {"-U", "flash:w:" + hex + ":i"});
  if (!args.keep_identity) {
    words.insert(words.end(), {"-U", fmt::format("eeprom:w:0x{:02x}:m", args.board)});
  }
  return words;
}

int Flash(const FlashArguments& args) {
  Diagnostics found;
  const std::string hex = HexPath(args);
  std::error_code error;
  if (hex.empty() || !fs::is_regular_file(hex, error)) {
    found.Error("firmware.unknown", {hex.empty() ? "firmware" : hex},
                "the firmware file is missing",
                "build it with avr-g++ (docs/hardware/firmware.md), or name a file with --hex");
    return Fail(found, kBadInput);
  }
  if (args.fuses && args.programmer == "arduino") {
    found.Error("firmware.bootloader_sets_no_fuses", {}, "a bootloader cannot set fuses",
                "use a programmer, such as --programmer usbasp");
    return Fail(found, kBadInput);
  }
  std::vector<std::string> words = Words(args, hex);
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
  fmt::print("{}\n", line);
  std::fflush(stdout);
  if (args.dry_run) return kOk;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execvp(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
    found.Error("firmware.avrdude_failed", {}, "avrdude was killed or did not start");
  } else if (WEXITSTATUS(status) == 127) {
    found.Error("firmware.avrdude_missing", {}, "the program avrdude is missing",
                "install the package avrdude");
  } else if (WEXITSTATUS(status) != 0) {
    found.Error("firmware.avrdude_failed", {},
                fmt::format("avrdude failed with exit status {}", WEXITSTATUS(status)),
                "check the port, and close other programs that use it");
  }
  if (!found.ok()) return Fail(found, kFailed);
  fmt::print("Firmware written to board {}. `taut robot scan` lists it at 0x{:02x}.\n", args.board,
             board::BoardAddress(static_cast<std::uint8_t>(args.board)));
  return kOk;
}

}  // namespace

void AddRobotFlash(CLI::App& robot, int& exit_code) {
  auto args = std::make_shared<FlashArguments>();
  CLI::App* flash = robot.add_subcommand(
      "flash", "Write firmware and board number to a board, by avrdude over the board's USB.");
  flash->add_option("--board", args->board, "Number of the board, 0 to 5")
      ->required()
      ->option_text("N")
      ->check(WholeNumberWithin(0, board::kBoards - 1));
  flash
      ->add_option("--port", args->port,
                   "Serial port of the board, not of the adapter (default: /dev/ttyUSB0)")
      ->option_text("PORT");
  flash->add_option("--hex", args->hex, "Firmware file (default: shipped with taut)")
      ->option_text("FILE");
  flash
      ->add_option("--programmer", args->programmer,
                   "avrdude's name of the programmer (default: arduino, the bootloader)")
      ->option_text("NAME");
  flash
      ->add_option("--baud", args->baud,
                   "Baud rate of the bootloader (default: 57600; new ones: 115200)")
      ->option_text("N")
      ->check(WholeNumberWithin(1200, 1'000'000));
  flash->add_flag("--fuses", args->fuses,
                  "Set brown-out detection at 4.3 V; not possible with a bootloader");
  flash->add_flag("--keep_identity", args->keep_identity, "Leave the EEPROM unchanged");
  flash->add_flag("--dry_run,--dry-run", args->dry_run, "Print the avrdude command only");
  flash->footer(
      "Examples:\n  taut robot flash --board 0 --port /dev/ttyUSB0\n"
      "  taut robot flash --board 3 --programmer usbasp --port usb --fuses --dry_run\n"
      "Disconnect the motors' supply first. Not verified on hardware.");
  flash->callback([args, &exit_code] { exit_code = Flash(*args); });
}

}  // namespace taut::cli
