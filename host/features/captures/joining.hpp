// Joins captures of parts of a clip to one.
//
//   in:      captures that were encoded alike, of pictures that follow each other
//   out:     one capture of all these pictures, in the order of their times
//   always:  blocks are copied as they are, one at a time; before anything is written all captures were looked at
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "system/interruption.hpp"

namespace nutik {

struct JoinRequest {
  std::vector<std::filesystem::path> captures;
  std::filesystem::path output;
};

struct JoinedPart {
  std::string capture;
  std::uint64_t first_sample = 0;  // in the joined capture
  std::uint64_t sample_count = 0;
};

struct Joined {
  CaptureFormat capture;
  Timeline timeline;
  std::vector<JoinedPart> parts;  // in the order of their times
  std::uint64_t file_bytes = 0;
  std::vector<std::string> facts;  // as the header tells them
  std::vector<Note> notes;
};

// Captures that know their place in the clip may be named in any order; a note names pictures before the first and
// behind the last. Others need one constant rate and follow each other as named; a note says so. `progress` counts
// samples. Throws UsageError where fewer than two are named, or `output` is one of them or no capture's name;
// InputError where one is damaged, encoded otherwise, or leaves out or repeats pictures; OutputError.
[[nodiscard]] Joined join(const JoinRequest& request, const ReportedProgress& progress = {});

}  // namespace nutik
