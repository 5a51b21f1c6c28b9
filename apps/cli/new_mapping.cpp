// `taut new mapping`: guesses a mapping, verifies that it reads the log, writes it.
#include "new_mapping.h"

#include <fmt/format.h>

#include <filesystem>

#include "any_robot.h"
#include "output.h"
#include "standard_streams.h"
#include "taut/compare.h"
#include "taut/guess_mapping.h"

namespace taut::cli {
namespace {

template <class Member>
std::vector<std::string> Names(const std::vector<Member>& members) {
  std::vector<std::string> names;
  for (const Member& member : members) names.push_back(member.name);
  return names;
}

std::string DefaultOut(const std::string& log) {
  std::filesystem::path path(log);
  if (path.extension() == ".gz") path.replace_extension();
  return path.replace_extension(".map.json").string();
}

}  // namespace

int NewMapping(const NewMappingArguments& args) {
  Diagnostics found;
  RobotNames names;
  if (!args.model.empty()) {
    const auto robot = LoadAnyRobot(args.model, {}, found);
    if (!robot) return Fail(found, kBadInput);
    const ModelDef& model = robot->def;
    names = {Names(model.cables), Names(model.bodies), Names(model.nodes), Names(model.joints)};
  }
  found = {};
  const auto guess = GuessMapping(args.log, names, found);
  if (!guess) return Fail(found, kBadInput);

  const std::string out = args.out.empty() ? DefaultOut(args.log) : args.out;
  if (IsTaken(out)) return kBadInput;
  if (const int exit = WriteNamed(out, guess->text); exit != kOk) return exit;
  OutputIsNews();
  fmt::print("{}\n", args.log);
  for (const std::string& line : guess->results) fmt::print("  {}\n", line);
  for (const std::string& line : guess->doubts) fmt::print("  check: {}\n", line);
  if (args.model.empty()) {
    fmt::print("  check: without --model FILE, columns cannot be assigned to cables and bodies\n");
  }
  // A row after the sample may have another form.
  const auto mapping = LoadMapping(out, found);
  const auto trace = mapping ? ReadMapped(args.log, *mapping, out, found) : std::nullopt;
  if (!trace) {
    Fail(found, kBadInput);
    fmt::print("Written: {}, which does not read the whole file: correct it by hand\n", out);
    return kBadInput;
  }
  Pass(found, false);
  fmt::print("Written: {}, which reads {} rows from {:.6g} s to {:.6g} s\n", out,
             trace->time_s.size(), trace->time_s.front(), trace->time_s.back());
  SayNext({"compare", "runs/RUN", args.log, "--map", out});
  return kOk;
}

}  // namespace taut::cli
