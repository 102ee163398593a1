// Corrects what a capture says of itself, without encoding its clip again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "capture/timeline.hpp"
#include "tik/header.hpp"

namespace nutik {

struct RetimeRequest {
  std::filesystem::path capture;
  std::filesystem::path output;  // may be the capture itself, which is replaced when the new file is whole
  std::optional<Rational> rate;
  std::optional<Rational> shutter_angle;
  std::optional<Transfer> transfer;
  std::optional<Primaries> primaries;
  std::optional<Rational> pixel_aspect;

  [[nodiscard]] bool changes_nothing() const {
    return !rate && !shutter_angle && !transfer && !primaries && !pixel_aspect;
  }
};

struct Retimed {
  CaptureFormat capture;
  Timeline timeline;
  std::uint64_t file_bytes = 0;
  std::vector<std::string> facts;  // as the header tells them now
  std::vector<Note> notes;         // on what was lost
};

// The setting by which retime corrects this line of a header's facts; none where the clip has to be encoded again.
[[nodiscard]] std::optional<Setting> correction_of(std::string_view fact);

// Whether a capture's exposures were listed: its shutter angle is then their mean.
[[nodiscard]] bool lists_exposures(const tik::Header& header);

// Copies blocks as they are. Throws UsageError where nothing is to be changed, or samples are means of light by the
// transfer function that is to go; InputError where the capture is damaged; OutputError.
[[nodiscard]] Retimed retime(const RetimeRequest& request);

}  // namespace nutik
