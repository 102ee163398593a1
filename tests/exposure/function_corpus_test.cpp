// The shared corpus of function files, tests/corpus/functions: what expected.json says of each file
// is what the program reads from it, down to the words of its messages.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "exposure/function_file.hpp"

#ifndef NUTIK_TEST_CORPUS
#error "NUTIK_TEST_CORPUS is not set; it is the folder tests/corpus/functions"
#endif

namespace nutik {
namespace {

const std::filesystem::path kCorpus = NUTIK_TEST_CORPUS;

using Finding = std::tuple<std::size_t, std::size_t, std::string>;  // line, column, message
using Functions = std::map<std::uint8_t, std::vector<std::pair<std::int64_t, double>>>;

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  return {std::istreambuf_iterator<char>(file), {}};
}

nlohmann::json expectations() { return nlohmann::json::parse(read(kCorpus / "expected.json")); }

Functions expected_functions(const nlohmann::json& expected) {
  Functions functions;
  if (!expected.contains("functions")) return functions;  // an invalid file of which nothing is left
  for (const auto& [tag, points] : expected.at("functions").items()) {
    functions.emplace(static_cast<std::uint8_t>(std::stoi(tag)), points.get<Functions::mapped_type>());
  }
  return functions;
}

Functions functions_of(const FunctionFile& file) {
  Functions functions;
  for (const auto& [tag, parsed] : file.functions) {
    for (const ControlPoint& point : parsed.function.points()) {
      functions[tag].emplace_back(point.time_ns, point.gain);
    }
  }
  return functions;
}

std::vector<Finding> findings(const FunctionFile& file, Diagnostic::Severity severity) {
  std::vector<Finding> findings;
  for (const Diagnostic& diagnostic : file.diagnostics.shown()) {
    if (diagnostic.severity == severity) {
      findings.emplace_back(diagnostic.place.line, diagnostic.place.column, diagnostic.message);
    }
  }
  return findings;
}

// What expected.json lists under `key`; nothing where it has no such list.
std::vector<Finding> expected_findings(const nlohmann::json& expected, const char* key) {
  return expected.value(key, std::vector<Finding>{});
}

using Check = std::function<void(const nlohmann::json& expected, const FunctionFile& file)>;

// Runs `check` on every corpus file, with what is expected of it and what the program reads from it.
void for_each_file(const Check& check) {
  const nlohmann::json all = expectations();
  for (const auto& [name, expected] : all.items()) {
    SCOPED_TRACE(name + ": " + expected.at("shows").get<std::string>());
    FunctionFile file;
    EXPECT_NO_THROW(file = parse_functions(read(kCorpus / name)));
    SCOPED_TRACE(file.report(name));
    check(expected, file);
  }
}

TEST(FunctionCorpus, EveryFileHasItsExpectations) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kCorpus)) {
    if (entry.path().extension() == ".fn") files.insert(entry.path().filename().string());
  }
  std::set<std::string> expected;
  const nlohmann::json all = expectations();
  for (const auto& item : all.items()) expected.insert(item.key());
  EXPECT_EQ(files, expected);
  EXPECT_GE(files.size(), 60U);
}

TEST(FunctionCorpus, FilesGiveTheirFunctions) {
  for_each_file([](const nlohmann::json& expected, const FunctionFile& file) {
    EXPECT_EQ(file.has_errors(), !expected.at("valid").get<bool>());
    EXPECT_EQ(functions_of(file), expected_functions(expected));
  });
}

TEST(FunctionCorpus, EveryErrorIsReportedAtItsPlaceInTheExpectedWords) {
  for_each_file([](const nlohmann::json& expected, const FunctionFile& file) {
    EXPECT_EQ(findings(file, Diagnostic::Severity::error), expected_findings(expected, "errors"));
  });
}

TEST(FunctionCorpus, EveryWarningIsGivenAtItsPlaceInTheExpectedWords) {
  for_each_file([](const nlohmann::json& expected, const FunctionFile& file) {
    EXPECT_EQ(findings(file, Diagnostic::Severity::warning), expected_findings(expected, "warnings"));
  });
}

TEST(FunctionCorpus, WhatIsNotShownIsCounted) {
  for_each_file([](const nlohmann::json& expected, const FunctionFile& file) {
    const auto more = [&](Diagnostic::Severity severity) {
      return file.diagnostics.count(severity) - findings(file, severity).size();
    };
    EXPECT_EQ(more(Diagnostic::Severity::error), expected.value("more_errors", std::size_t{0}));
    EXPECT_EQ(more(Diagnostic::Severity::warning), expected.value("more_warnings", std::size_t{0}));
  });
}

}  // namespace
}  // namespace nutik
