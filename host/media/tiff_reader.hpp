// TIFF stacks, page after page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "capture/picture.hpp"

struct tiff;

namespace nutik {

// One page's codes as stored: code8 up to 8 bits a value, else code16. Values of 9 to 15 bits are
// unpacked and not scaled.
struct TiffPage {
  Picture picture;
  // The largest code there can be, where the file tells: fewer than 16 bits a value, or the tag
  // MaxSampleValue. That tag may also be the largest value that happens to occur; so it counts only
  // where it is 2^n - 1, all that n bits can hold.
  std::optional<std::uint32_t> maximum;
};

class TiffReader {
 public:
  // Throws InputError where the file is no TIFF.
  explicit TiffReader(const std::filesystem::path& path);
  ~TiffReader();
  TiffReader(TiffReader&&) noexcept;
  TiffReader& operator=(TiffReader&&) noexcept;

  // Walks through the file's directories, without reading a pixel.
  [[nodiscard]] static std::uint64_t count_pages(const std::filesystem::path& path);

  // The next page, in time proportional to its size. Empty after the last one. Throws InputError
  // naming file and page where it is damaged or of a kind that is not read.
  [[nodiscard]] std::optional<TiffPage> next();

 private:
  std::string name_;
  struct Close {
    void operator()(tiff* file) const;
  };
  std::unique_ptr<tiff, Close> file_;
  std::uint64_t pages_read_ = 0;
  bool at_end_ = false;
};

}  // namespace nutik
