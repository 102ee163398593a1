// What is read of a picture's file, and how one is written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capture/picture.hpp"
#include "system/interruption.hpp"

namespace nutik {

class OutputFile;

// A picture as it lies in its file, codes or light, and what the file says of it.
struct FilePicture {
  Picture picture;
  // The largest code there can be, where the file tells.
  std::optional<std::uint32_t> maximum = {};
  // How many of its pixels are as long as one and the same length, along a row and along a column, of no unit.
  std::optional<std::pair<double, double>> density = {};
  std::vector<std::byte> profile = {};  // ICC; empty where there is none that can be read, or not all of it
  unsigned orientation = 1;             // as it lies, by EXIF's numbers, which are TIFF's
  std::string left_out = {};            // channels beside these (media/clip.hpp)
  bool has_palette = false;             // of a TIFF: these are its colours
};

// What a person asked of a file beside its values.
struct FileWishes {
  static constexpr int kDefaultQuality = 90;
  int quality = kDefaultQuality;  // 1 … 100, of lossy files
  bool as_half = false;         // light in 16 bits
  bool square_pixels = false;   // of files that people look at: .png and .jpg
  // Called often while a file is written: what it throws leaves no file. Empty where a signal must not lose a picture.
  std::function<void()> check = check_interruption;
};

// What files of a name hold, and how they are written.
struct WrittenFormat {
  std::string_view extension = {}, also = {};  // messages name the first one; either may be empty
  std::uint32_t code_bits = 0;                 // that it holds at most; 0: no codes
  bool holds_light = false;                    // in 32 bits
  bool holds_half = false;                     // in 16
  bool holds_double = false;                   // in 64
  bool is_lossy = false;                       // codes
  bool is_for_eyes = false;                    // shown by viewers that take pixels for square ones
  bool is_silent = false;                      // has no place for what values mean
  std::uint32_t only_channels = 0;             // 0: any
  // The text is empty where its kind has no place for one. Throws OutputError.
  void (*write)(OutputFile& file, const Picture& picture, const std::string& text, const FileWishes& wishes) = nullptr;
  void (*write_layers)(OutputFile& file, std::span<const PictureLayer> layers) = nullptr;  // null: it holds one picture
};

}  // namespace nutik
