// Lets tests open clips in their own process: the module that decodes them lies beside the program,
// not beside the tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "media/clip.hpp"
#include "support/stills.hpp"

namespace nutik::test {

inline void use_modules() {
  const auto folder = std::filesystem::path(NUTIK_TEST_PROGRAM).parent_path();
  setenv("NUTIK_MODULES", folder.c_str(), 0);
}

inline std::unique_ptr<Clip> open_test_clip(const std::filesystem::path& path,
                                            const ClipOptions& options = {}) {
  use_modules();
  return open_clip(path, options);
}

inline std::map<Setting, Fact> facts_of(const Clip& clip) {
  std::map<Setting, Fact> facts;
  for (const Fact& fact : clip.info().facts) facts.insert({fact.setting, fact});
  return facts;
}

// What is doubtful about a clip, a line each.
inline std::string notes_of(const Clip& clip) {
  std::string all;
  for (const Note& note : clip.info().notes) all += note.text + "\n";
  return all;
}

inline std::vector<std::vector<std::byte>> read_all(Clip& clip) {
  std::vector<std::vector<std::byte>> rasters;
  std::vector<std::byte> raster(clip.info().format.sample_bytes());
  while (clip.read(raster)) rasters.push_back(raster);
  return rasters;
}

// The clip holds these pictures, code for code.
inline void expect_codes(Clip& clip, const std::vector<Picture>& pictures) {
  EXPECT_EQ(clip.info().format.shape, pictures[0].shape);
  EXPECT_EQ(clip.info().sample_count, pictures.size());
  const auto rasters = read_all(clip);
  ASSERT_EQ(rasters.size(), pictures.size());
  for (std::size_t k = 0; k < pictures.size(); ++k) EXPECT_EQ(difference(rasters[k], pictures[k]), "") << k;
}

}  // namespace nutik::test
