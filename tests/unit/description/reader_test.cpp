// YAML reader: tree, values and maps, with places of errors
#include "description/yaml/reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>

namespace taut::description {
namespace {

std::string ParseErrors(const std::string& yaml) {
  Diagnostics out;
  const ValuePtr root = ParseYaml(yaml, "f.yaml", out);
  EXPECT_EQ(root == nullptr, !out.ok());
  return out.Format();
}

ValuePtr Parse(const std::string& yaml) {
  Diagnostics out;
  ValuePtr root = ParseYaml(yaml, "f.yaml", out);
  EXPECT_EQ(out.Format(), "");
  return root;
}

// --- the tree --------------------------------------------------------------------------------

TEST(YamlTree, EveryValueKnowsItsLineAndColumn) {
  const ValuePtr root = Parse("a: 1\nlist:\n  - [x, yy]\n  - {k: v}\n");
  EXPECT_EQ(root->entries[1].key_at.line, 2);
  EXPECT_EQ(root->Find("a")->at.column, 4);
  const Value& inner = *root->Find("list")->items[0]->items[1];
  EXPECT_EQ(inner.text, "yy");
  EXPECT_EQ(inner.at.line, 3);
  EXPECT_EQ(inner.at.column, 9);
  EXPECT_EQ(root->Find("list")->items[1]->entries[0].value->at.column, 9);
}

TEST(YamlTree, DuplicateKeysAreErrors) {
  EXPECT_EQ(ParseErrors("a: 1\nb: 2\na: 3\n"),
            "f.yaml:3:1: error: duplicate key \"a\" (first in line 1)\n");
  EXPECT_EQ(ParseErrors("m: {a: 1, a: 1}\nn: {b: 1, b: 2}\n"),
            "f.yaml:1:11: error: duplicate key \"a\" (first in line 1)\n"
            "f.yaml:2:11: error: duplicate key \"b\" (first in line 2)\n");
}

TEST(YamlTree, AnchorsAndMergeKeysWork) {
  const ValuePtr root = Parse(
      "base: &b {x: 1, y: 2}\none: {<<: *b, y: 3}\ntwo: *b\n"
      "three: {<<: [{z: 9, x: 8}, *b]}\n");
  EXPECT_EQ(root->Find("one")->Find("x")->text, "1");
  EXPECT_EQ(root->Find("one")->Find("y")->text, "3");
  EXPECT_EQ(root->Find("one")->entries.size(), 2u);
  EXPECT_EQ(root->Find("two")->Find("y")->text, "2");
  EXPECT_EQ(root->Find("three")->Find("x")->text, "8");
  EXPECT_EQ(root->Find("three")->Find("y")->text, "2");
  EXPECT_EQ(root->Find("one")->Find("<<"), nullptr);
}

TEST(YamlTree, MergingSomethingElseIsAnError) {
  EXPECT_EQ(ParseErrors("a: {<<: 3}\n"), "f.yaml:1:5: error: `<<` needs a map, not a text\n");
  EXPECT_EQ(ParseErrors("a: {<<: [3]}\n"), "f.yaml:1:10: error: `<<` needs a map, not a text\n");
}

TEST(YamlTree, WhatIsNotYamlSaysWhere) {
  EXPECT_EQ(ParseErrors("a: [1, 2\nb: 3\n"),
            "f.yaml:2:2: error: the file is not valid YAML: end of sequence flow not found\n");
  EXPECT_EQ(
      ParseErrors("a: *nowhere\n"),
      "f.yaml:1:4: error: the file is not valid YAML: the referenced anchor is not defined\n");
}

TEST(YamlTree, OneDocumentWithoutTagsAndWithTextKeys) {
  EXPECT_EQ(ParseErrors(""), "f.yaml:1:1: error: the file is empty\n");
  EXPECT_EQ(ParseErrors("a: 1\n---\nb: 1\n"),
            "f.yaml:2:1: error: the file has more than one YAML document (remove the `---` between "
            "them)\n");
  EXPECT_EQ(ParseErrors("a: !!str 3\n"),
            "f.yaml:1:4: error: YAML tag \"tag:yaml.org,2002:str\" is not allowed\n");
  EXPECT_EQ(ParseErrors("? [a]\n: 1\n"), "f.yaml:1:3: error: a key must be a text, not a list\n");
  EXPECT_EQ(ParseErrors("a: &a [*a]\n"),
            "f.yaml:1:8: error: a YAML anchor must not contain itself\n");
}

TEST(YamlTree, NoTextHasControlCharacters) {
  const std::string hint =
      " is not allowed (expected UTF-8 without control characters except tabs and line ends)\n";
  // A NUL would truncate the path in system calls.
  EXPECT_EQ(ParseErrors("model: \"a.yaml\\0.txt\"\n"),
            "f.yaml:1:8: error: the control character 0" + hint);
  EXPECT_EQ(ParseErrors("a: {\"\\e[2J\": 1}\n"),
            "f.yaml:1:5: error: the control character 27" + hint);
  EXPECT_EQ(ParseErrors(std::string("a: 1\nb: x\0y\n", 12)),
            "f.yaml:2:5: error: the control character 0" + hint);
  // yaml-cpp would treat the character as the end of the file and ignore `b`.
  EXPECT_EQ(ParseErrors("a: 1\n\x04\nb: 2\n"), "f.yaml:2:1: error: the control character 4" + hint);
  EXPECT_EQ(ParseErrors("a: \"b\\tc\\n\"\r\n"), "");
}

TEST(YamlTree, NestingIsLimited) {
  EXPECT_EQ(ParseErrors(std::string(65, '[') + std::string(65, ']')),
            "f.yaml:1:65: error: the file is nested more than 64 levels deep\n");
  EXPECT_EQ(ParseErrors(std::string(64, '[') + std::string(64, ']')), "");
  EXPECT_NE(ParseErrors(std::string(100'000, '[')), "");
}

TEST(YamlTree, NodesAreLimitedAndAliasesCountFully) {
  std::string large = "a: [";
  for (int i = 0; i < 1'000'000; ++i) large += "1, ";
  EXPECT_EQ(ParseErrors(large + "1]").substr(0, 60),
            "f.yaml:1:3000002: error: the file has more than 1000000 YAML");
  // Each line multiplies by ten: a billion nodes in ten lines.
  std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before;
    for (int k = 1; k < 10; ++k) laughs += ", " + before;
    laughs += "]\n";
  }
  EXPECT_NE(ParseErrors(laughs).find("more than 1000000 YAML nodes"), std::string::npos);
}

TEST(YamlTree, FilesThatCannotBeReadSayWhy) {
  Diagnostics out;
  EXPECT_EQ(ReadYaml("/no/such/file.yaml", out), nullptr);
  EXPECT_EQ(out.Format(), "/no/such/file.yaml: error: cannot open: No such file or directory\n");
  Diagnostics directory;
  EXPECT_EQ(ReadYaml(TAUT_SOURCE_DIR, directory), nullptr);
  EXPECT_EQ(directory.items()[0].what, "the path is a directory, not a file");
  const std::string path = ::testing::TempDir() + "taut_large.yaml";
  std::ofstream(path) << "a: " << std::string(kMaxFileBytes, '#');
  Diagnostics large;
  EXPECT_EQ(ReadYaml(path, large), nullptr);
  EXPECT_EQ(large.items()[0].what, "the file is larger than 10 MB");
  std::remove(path.c_str());
}

// --- values ----------------------------------------------------------------------------------

class Reading : public ::testing::Test {
 protected:
  /// Returns the value of `v` in the file `v: <text>`; it starts at line 1, column 4.
  const Value& V(const std::string& text) {
    kept_.push_back(Parse("v: " + text));
    return *kept_.back()->Find("v");
  }
  /// Returns all errors so far and clears them.
  std::string Errors() {
    std::string text = out_.Format();
    out_ = Diagnostics();
    return text;
  }

  NameTable names_{{"edge_m", 0.5}};
  Diagnostics out_;
  Scope scope_{names_, out_};
  std::vector<ValuePtr> kept_;
};

TEST_F(Reading, NumbersMayBeExpressions) {
  EXPECT_EQ(ReadNumber(V("2 * edge_m"), "x_m", Bound::kPositive, scope_), 1.0);
  EXPECT_EQ(ReadNumber(V("'2 * 3'"), "x_m", Bound::kAny, scope_), 6.0);
  EXPECT_EQ(ReadNumber(V("0"), "x_m", Bound::kNonNegative, scope_), 0.0);
  EXPECT_EQ(ReadNumber(V("1"), "x", Bound::kFraction, scope_), 1.0);
  EXPECT_EQ(Errors(), "");
}

TEST_F(Reading, NumbersAreCheckedForKindRangeAndFiniteness) {
  const auto error = [&](const std::string& text, Bound bound) {
    EXPECT_TRUE(std::isnan(ReadNumber(V(text), "rod.radius_m", bound, scope_)));
    return Errors();
  };
  const std::string at = "f.yaml:1:4: error: rod.radius_m";
  EXPECT_EQ(error("-1", Bound::kPositive), at + " must be positive, got -1\n");
  EXPECT_EQ(error("0", Bound::kPositive), at + " must be positive, got 0\n");
  EXPECT_EQ(error("-0.25", Bound::kNonNegative), at + " must not be negative, got -0.25\n");
  EXPECT_EQ(error("1.5", Bound::kFraction), at + " must be within 0..1, got 1.5\n");
  EXPECT_EQ(error(".nan", Bound::kAny), at + " must be a finite number, got .nan\n");
  EXPECT_EQ(error("-.inf", Bound::kAny), at + " must be a finite number, got -.inf\n");
  EXPECT_EQ(error("NaN", Bound::kAny), at + " must be a finite number, got NaN\n");
  EXPECT_EQ(error("[1]", Bound::kAny), at + " must be a number, got a list\n");
  EXPECT_EQ(error("", Bound::kAny),
            "f.yaml:1:1: error: rod.radius_m must be a number, got nothing\n");
  EXPECT_EQ(error("edge_n", Bound::kAny),
            at + ": unknown name \"edge_n\" (did you mean \"edge_m\"?)\n");
  EXPECT_EQ(error("true", Bound::kAny), at + ": unknown name \"true\" (one of: edge_m)\n");
}

TEST_F(Reading, IntegersAreWholeAndWithinTheirRange) {
  EXPECT_EQ(ReadInteger(V("6 * edge_m"), "copies", 1, 10, scope_), 3);
  EXPECT_EQ(Errors(), "");
  EXPECT_FALSE(ReadInteger(V("2.5"), "copies", 1, 10, scope_));
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: copies must be a whole number within 1..10, got 2.5\n");
  EXPECT_FALSE(ReadInteger(V("1e300"), "copies", 1, 10, scope_));
  EXPECT_EQ(Errors(),
            "f.yaml:1:4: error: copies must be a whole number within 1..10, got 1e+300\n");
}

TEST_F(Reading, BooleansAreTrueOrFalse) {
  EXPECT_EQ(ReadBool(V("true"), "collides", scope_), true);
  EXPECT_EQ(ReadBool(V("false"), "collides", scope_), false);
  EXPECT_EQ(Errors(), "");
  EXPECT_FALSE(ReadBool(V("yes"), "collides", scope_));
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: collides must be true or false, got \"yes\"\n");
  EXPECT_FALSE(ReadBool(V("{}"), "collides", scope_));
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: collides must be true or false, got a map\n");
}

TEST_F(Reading, VectorsHaveThreeNumbers) {
  const Vec3 v = ReadVec3(V("[1, -edge_m, 2 * 3]"), "at_m", scope_);
  EXPECT_EQ(v.x, 1.0);
  EXPECT_EQ(v.y, -0.5);
  EXPECT_EQ(v.z, 6.0);
  EXPECT_EQ(Errors(), "");
  ReadVec3(V("[1, 2]"), "at_m", scope_);
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: at_m must have 3 numbers, got 2\n");
  ReadVec3(V("1"), "at_m", scope_);
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: at_m must be a list of 3 numbers, got a text\n");
  ReadVec3(V("[1, x, 3]"), "at_m", scope_);
  EXPECT_EQ(Errors(), "f.yaml:1:8: error: at_m: unknown name \"x\" (one of: edge_m)\n");
}

TEST_F(Reading, DirectionsHaveLengthOneWhateverTheirScale) {
  const Vec3 v = ReadDirection(V("[3e200, 0, -4e200]"), "direction", scope_);
  EXPECT_DOUBLE_EQ(v.x, 0.6);
  EXPECT_DOUBLE_EQ(v.z, -0.8);
  EXPECT_EQ(Errors(), "");
  ReadDirection(V("[0, 0, 0]"), "direction", scope_);
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: direction must not be zero (it is a direction)\n");
}

TEST_F(Reading, NamesAreLettersDigitsUnderscoresAndHyphens) {
  EXPECT_EQ(ReadName(V("a_b-3"), "name", scope_), "a_b-3");
  EXPECT_EQ(ReadNames(V("[a, b]"), "tags", scope_), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(ReadNames(V("a"), "tags", scope_), (std::vector<std::string>{"a"}));
  EXPECT_EQ(Errors(), "");
  ReadName(V("a.b"), "name", scope_);
  EXPECT_EQ(Errors(),
            "f.yaml:1:4: error: name: \"a.b\" cannot be a name (use letters, digits, _ and -)\n");
  ReadName(V("[a]"), "name", scope_);
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: name must be a name, got a list\n");
  ReadNames(V("{a: b}"), "tags", scope_);
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: tags must be a name or a list of names, got a map\n");
  ReadName(V(std::string(201, 'a')), "name", scope_);
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: name: a name has at most 200 characters\n");
  ReadText(V("[a]"), "description", scope_);
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: description must be a text, got a list\n");
}

TEST_F(Reading, MatchIsATagOrAllOfAListOrAnyOfLists) {
  const auto match = [&](const std::string& text, const std::vector<std::string>& tags) {
    return Matches(ReadMatch(V(text), "match", scope_), tags);
  };
  EXPECT_TRUE(match("a", {"a", "b"}));
  EXPECT_FALSE(match("c", {"a", "b"}));
  EXPECT_TRUE(match("[a, b]", {"a", "b"}));
  EXPECT_FALSE(match("[a, c]", {"a", "b"}));
  EXPECT_TRUE(match("[[c], [a, b]]", {"a", "b"}));
  EXPECT_FALSE(match("[[c], [a, d]]", {"a", "b"}));
  EXPECT_TRUE(match("segment_0.tip", {"segment_0.tip"}));
  EXPECT_EQ(Errors(), "");
  EXPECT_FALSE(match("[]", {"a"}));
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: match must not be empty (name the tags to match)\n");
  EXPECT_FALSE(match("[[], []]", {"a"}));
  EXPECT_EQ(Errors(),
            "f.yaml:1:5: error: match must not be empty (name the tags to match)\n"
            "f.yaml:1:9: error: match must not be empty (name the tags to match)\n");
}

TEST_F(Reading, ChoicesHintAtTheLikelyOne) {
  enum class Law { kCone, kAlongSlip };
  const std::vector<std::pair<std::string, Law>> laws{{"cone", Law::kCone},
                                                      {"along_slip", Law::kAlongSlip}};
  EXPECT_EQ(ReadChoice<Law>(V("along_slip"), "law", laws, scope_), Law::kAlongSlip);
  EXPECT_EQ(Errors(), "");
  EXPECT_FALSE(ReadChoice<Law>(V("cones"), "law", laws, scope_));
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: law cannot be \"cones\" (did you mean \"cone\"?)\n");
  EXPECT_FALSE(ReadChoice<Law>(V("[cone]"), "law", laws, scope_));
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: law must be a text, got a list\n");
}

// --- maps ------------------------------------------------------------------------------------

class ReadingMaps : public Reading {
 protected:
  /// Reads a rod with these known keys.
  MapReader Rod(const Value& value, const std::vector<std::string>& keys) {
    MapReader map(value, "rod", scope_);
    for (const std::string& key : keys) map.Know(key);
    map.RefuseOthers();
    return map;
  }
};

TEST_F(ReadingMaps, UnknownKeysAreErrorsWithHints) {
  Rod(V("{radius: 1, densty_kg_per_m3: 2, damping: 3, zzzzzz: 4}"),
      {"radius_m", "density_kg_per_m3", "damping_n_s_per_m", "damping_law"});
  EXPECT_EQ(Errors(),
            "f.yaml:1:5: error: unknown key \"radius\" in rod (did you mean \"radius_m\"?)\n"
            "f.yaml:1:16: error: unknown key \"densty_kg_per_m3\" in rod (did you mean "
            "\"density_kg_per_m3\"?)\n"
            "f.yaml:1:37: error: unknown key \"damping\" in rod (did you mean "
            "\"damping_n_s_per_m\" or \"damping_law\"?)\n"
            "f.yaml:1:49: error: unknown key \"zzzzzz\" in rod (one of: radius_m, "
            "density_kg_per_m3, damping_n_s_per_m, damping_law)\n");
}

TEST_F(ReadingMaps, MissingKeysAreErrorsAtTheMap) {
  const MapReader map = Rod(V("{a: 1}"), {"a", "b", "c"});
  EXPECT_EQ(map.NumberOr("a", 0, Bound::kAny), 1.0);
  EXPECT_EQ(map.NumberOr("b", 7, Bound::kAny), 7.0);
  EXPECT_TRUE(std::isnan(map.Number("b", Bound::kAny)));
  EXPECT_FALSE(map.Require("c"));
  EXPECT_EQ(Errors(),
            "f.yaml:1:4: error: rod needs the key \"b\"\n"
            "f.yaml:1:4: error: rod needs the key \"c\"\n");
}

TEST_F(ReadingMaps, SomethingElseThanAMapIsOneErrorNotMany) {
  const MapReader map = Rod(V("3"), {"a", "b"});
  map.Number("a", Bound::kAny);
  map.Require("b");
  map.ExactlyOne({"a", "b"});
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: rod must be a map, got a text\n");
}

TEST_F(ReadingMaps, ExactlyOneOfSeveralKeys) {
  const std::vector<std::string> keys{"mass_kg", "density_kg_per_m3"};
  EXPECT_EQ(Rod(V("{mass_kg: 1}"), keys).ExactlyOne(keys), "mass_kg");
  EXPECT_EQ(Errors(), "");
  EXPECT_EQ(Rod(V("{}"), keys).ExactlyOne(keys), "");
  EXPECT_EQ(Errors(), "f.yaml:1:4: error: rod needs one of mass_kg, density_kg_per_m3\n");
  EXPECT_EQ(Rod(V("{mass_kg: 1, density_kg_per_m3: 2}"), keys).ExactlyOne(keys), "");
  EXPECT_EQ(
      Errors(),
      "f.yaml:1:17: error: rod has both mass_kg and density_kg_per_m3 (give only one of them)\n");
}

TEST(Hints, NameTwelveOrAllOfFourteen) {
  std::vector<std::string> names;
  std::string twelve = "one of:";
  for (int i = 0; i < 15; ++i) {
    names.push_back("quite_long_" + std::to_string(i));
    if (i < 12) twelve += (i == 0 ? " " : ", ") + names.back();
  }
  EXPECT_EQ(DidYouMean("x", names), twelve + ", ...");
  names.pop_back();
  EXPECT_EQ(DidYouMean("x", names), twelve + ", quite_long_12, quite_long_13");
}

TEST(Header, TautAndKindMustBeRight) {
  const auto errors = [](const std::string& yaml) {
    Diagnostics out;
    const bool good = CheckHeader(*Parse(yaml), "model", out);
    EXPECT_EQ(good, out.ok());
    return out.Format();
  };
  EXPECT_EQ(errors("taut: 1\nkind: model\n"), "");
  EXPECT_EQ(errors("taut: 2\nkind: model\n"),
            "f.yaml:1:7: error: taut must be 1, got 2 (it is the version of the file format; this "
            "program reads version 1)\n");
  EXPECT_EQ(errors("taut: 1\nkind: experiment\n"),
            "f.yaml:2:7: error: kind must be model, got experiment (use `taut run` for files of "
            "this kind)\n");
  EXPECT_EQ(errors("taut: 1\nkind: study\n"),
            "f.yaml:2:7: error: kind must be model, got study (use `taut learn` for files of this "
            "kind)\n");
  EXPECT_EQ(errors("taut: 1\nkind: robot\n"),
            "f.yaml:2:7: error: kind must be model, got robot (the kinds are model, experiment, "
            "gait, study, fit, catalogue, calibration, faults)\n");
  EXPECT_EQ(errors("name: x\n"),
            "f.yaml:1:1: error: the file needs the key \"kind\" (write `kind: model`)\n"
            "f.yaml:1:1: error: the file needs the key \"taut\" (write `taut: 1`)\n");
  EXPECT_EQ(errors("[1]\n"),
            "f.yaml:1:1: error: the file must be a map, got a list (begin the file with `taut: 1` "
            "and `kind: model`)\n");
}

TEST(Paths, AreSeenFromTheFilesFolder) {
  EXPECT_EQ(PathBeside("experiments/push.yaml", "../models/t.yaml"), "models/t.yaml");
  EXPECT_EQ(PathBeside("push.yaml", "t.yaml"), "t.yaml");
  EXPECT_EQ(PathBeside("a/b.yaml", "/x/t.yaml"), "/x/t.yaml");
}

}  // namespace
}  // namespace taut::description
