// TIFF stacks, page after page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/error.hpp"
#include "capture/picture.hpp"
#include "capture/rational.hpp"
#include "media/formats/picture_format.hpp"

namespace nutik {

// What the description of a TIFF says of its pages beside what their directories do: ImageJ, tifffile and OME write
// there how many pictures there are, of how many channels and slices, and how fast they were taken.
struct TiffStory {
  std::string who;               // whose words these are
  std::uint64_t pictures = 0;    // 0: it does not say
  std::string refused;           // why several pages are not moments, with the way out, behind the file's name
  std::string unread;            // why no page is read, likewise
  std::optional<Rational> rate;  // pictures a second
  std::vector<std::int64_t> starts_ns;  // of all pictures, where they are not those of the rate
  std::string rate_doubt;               // what it says of the rate, and is not read
  std::optional<std::uint32_t> white;   // of codes of 16 bits
  std::vector<Note> notes;
};

// What pages of that shape take, in a file of that name.
[[nodiscard]] TiffStory read_tiff_story(std::string_view description, const Shape& page, std::string_view file);
// The largest code of so many bits, which are more than 8 and fewer than 16.
[[nodiscard]] std::optional<std::uint32_t> white_of_bits(std::string_view bits);
// What Micro-Manager writes beside a page: its camera's bits.
[[nodiscard]] std::optional<std::uint32_t> white_of_micro_manager(std::string_view json);

class TiffReader {
 public:
  // Walks through the file's directories, without reading a pixel. Throws InputError where the file is no TIFF, or
  // where their chain breaks: what lies behind that would be missing without a word. Where `ends_at_damage`, that is
  // the last of its pages, and next() throws.
  explicit TiffReader(const std::filesystem::path& path, bool ends_at_damage = false);
  ~TiffReader();

  // One directory may stand for many pages, whose codes lie one behind the other, as the description says.
  [[nodiscard]] std::uint64_t page_count() const { return page_count_; }
  // Whether it says that it is a DNG.
  [[nodiscard]] bool is_dng() const;
  // What the first page's description says.
  [[nodiscard]] const TiffStory& story() const { return story_; }

  // The next page, in time proportional to its size. Empty after the last one. Throws InputError
  // naming file and page where it is damaged, as far as libtiff notices, or of a kind that is not read.
  // Values are as stored: code8 up to 8 bits a value, else code16. Those of 9 to 15 bits are unpacked and not scaled.
  // Floating point is light32 or light64. Its maximum is told by fewer than 16 bits a value, or the tag MaxSampleValue.
  // That tag may also be the largest value that happens to occur; so it counts only where it is 2^n - 1, all that n
  // bits can hold.
  [[nodiscard]] std::optional<FilePicture> next();
  // Passes over the pages before that one, from 1, none of which is read.
  void pass_to(std::uint64_t page);

 private:
  struct File;

  // The directory of the next page; false where it cannot be read.
  bool find_next();
  void leave_copies_out();
  // Throws where the description says of more than moments; makes pages of what it says that no directory does.
  void follow_story(const std::filesystem::path& path, bool ends_at_damage);

  std::string name_;
  std::unique_ptr<File> file_;
  std::uint64_t page_count_ = 0;
  std::uint64_t pages_read_ = 0;
  std::vector<bool> is_moment_;  // of each directory
  TiffStory story_;
  bool is_in_one_ = false;  // whether all pages have the first one's directory
};

}  // namespace nutik
