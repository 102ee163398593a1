// The table of kinds of input, and the page that shows it.
#include "media/formats/input_kinds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <vector>

#include "media/formats/file_kinds.hpp"
#include "support/scratch.hpp"

namespace nutik::test {
namespace {

using Rows = std::vector<std::vector<std::string>>;

// The cells of the rows below that head.
Rows rows_of_page(const std::string& head) {
  std::istringstream page(read_file(NUTIK_INPUT_PAGE));
  Rows rows;
  bool is_within = false;
  for (std::string line; std::getline(page, line);) {
    if (is_within && !line.starts_with("|")) break;
    if (is_within && !line.starts_with("| ---")) {
      rows.emplace_back();
      for (std::size_t from = 2; from < line.size();) {
        const std::size_t to = line.find(" |", from);
        rows.back().push_back(line.substr(from, to - from));
        from = to + 3;
      }
    }
    is_within |= line == head;
  }
  return rows;
}

// How files are recognized, in words.
std::string recognized(const inputs::InputKind& kind) {
  std::vector<std::string> ways;
  if (!kind.starts[0].empty()) ways.emplace_back("first bytes");
  std::istringstream extensions{std::string(kind.extensions)};
  for (std::string extension; extensions >> extension;) ways.push_back("`" + extension + "`");
  if (!kind.otherwise.empty()) ways.emplace_back(kind.otherwise);
  std::string text;
  for (const std::string& way : ways) text += (text.empty() ? "" : ", ") + way;
  return text;
}

std::vector<const inputs::InputKind*> all_kinds() {
  std::vector<const inputs::InputKind*> kinds{&inputs::kVideo, &inputs::kRawVideo, &inputs::kPhantom,
                                              &inputs::kCapture};
  kinds.insert(kinds.end(), std::begin(inputs::kStills), std::end(inputs::kStills));
  kinds.insert(kinds.end(), std::begin(inputs::kClips), std::end(inputs::kClips));
  return kinds;
}

TEST(InputKindTable, IsThatOfThePageCellByCell) {
  const Rows page = rows_of_page(
      "| kind | recognized by | rate and times | shutter | codes, black and white | orientation | alpha | order |");
  const std::vector<const inputs::InputKind*> kinds = all_kinds();
  ASSERT_EQ(page.size(), kinds.size());
  for (const inputs::InputKind* each : kinds) {
    const inputs::InputKind& kind = *each;
    const auto row = std::ranges::find(page, kind.name, [](const auto& cells) { return cells.front(); });
    ASSERT_NE(row, page.end()) << kind.name;
    const auto& [times, shutter, codes, orientation, alpha, order] = kind.said;
    const std::vector<std::string> cells{std::string(kind.name),  recognized(kind),   std::string(times),
                                         std::string(shutter),    std::string(codes), std::string(orientation),
                                         std::string(alpha),      std::string(order)};
    ASSERT_EQ(row->size(), cells.size()) << kind.name;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      EXPECT_NE(cells[cell], "") << kind.name << ", cell " << cell;
      EXPECT_EQ((*row)[cell], cells[cell]) << kind.name << ", cell " << cell;
    }
  }
}

// No two claim the same file, and none claims what is refused by name.
TEST(InputKindTable, TellsFilesApart) {
  const Scratch scratch;
  std::set<std::string> extensions;
  for (const inputs::InputKind* kind : all_kinds()) {
    std::istringstream all{std::string(kind->extensions)};
    for (std::string extension; all >> extension;) {
      EXPECT_TRUE(extensions.insert(extension).second) << extension;
      EXPECT_TRUE(kind->is_named("a" + extension)) << extension;
      EXPECT_TRUE(kind->is_named("B.C" + extension)) << extension;
      EXPECT_FALSE(kind->is_named(extension.substr(1))) << extension;
      EXPECT_FALSE(kind->is_named("a" + extension + "0")) << extension;
    }
    for (const std::string_view start : kind->starts) {
      if (start.empty()) continue;
      const std::string front = std::string(start) + std::string(kind->behind_start.substr(0, 1));
      const auto claims = [&](const inputs::InputKind* other) { return other->begins(front); };
      EXPECT_EQ(std::ranges::count_if(all_kinds(), claims), 1) << kind->name;
      EXPECT_FALSE(kind->begins(front.substr(0, front.size() - 1))) << kind->name;
      const auto file = scratch.write("file", front + std::string(64, '\0'));
      EXPECT_EQ(unsupported_kind_text(file), std::nullopt) << kind->name;
    }
  }
  EXPECT_FALSE(inputs::kPng.is_named("png"));
  EXPECT_FALSE(inputs::kPng.is_named(""));
}

}  // namespace
}  // namespace nutik::test
