#include "capture/part_of_clip.hpp"

#include "capture/format.hpp"
#include "capture/seconds_text.hpp"

namespace nutik {
namespace {

constexpr std::string_view kPictures = "pictures ";

}  // namespace

std::string PartOfClip::text(std::optional<std::uint64_t> end) const {
  std::string told = format("{}{} … {}", kPictures, first, end ? std::to_string(*end - 1) : "");
  if (pictures > 0) told += format(" of {}", pictures);
  if (start_ns > 0) told += format(", whose time 0 is {} after the clip's", seconds_text(start_ns));
  return told;
}

bool tells_part(std::string_view fact) { return fact.starts_with(kPictures); }

}  // namespace nutik
