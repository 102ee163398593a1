// Makes a mask as it was asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/error.hpp"
#include "capture/memory_needs.hpp"
#include "exposure/mask.hpp"
#include "features/masks/mask_request.hpp"
#include "imev/capture_source.hpp"
#include "media/formats/numbered_name.hpp"
#include "session/exposed_picture.hpp"
#include "session/output_check.hpp"
#include "session/session.hpp"

namespace nutik {

// What a step came to.
struct StepReport {
  std::string name;
  std::uint8_t tag = 0;                   // of a grid, the first
  std::uint8_t last_tag = 0;              // of a grid; else the same
  std::uint64_t pixel_count = 0;          // that it gave its tag
  std::optional<std::uint32_t> by_codes;  // more than which a code had to change
  // The share of a subject's border along which the plate has an edge, not the picture (scene/clean_plate.hpp).
  std::optional<double> plate_edges = {};
  // And that along which the picture has one, not the plate: of light that changed, little.
  std::optional<double> own_edges = {};
  std::vector<std::uint8_t> covered_tags;  // its tags that later steps left on no pixel
};

struct MadeMask {
  Mask mask;
  std::vector<StepReport> steps;
  std::vector<std::string> notes;  // whole sentences
};

// What making a mask of a capture takes, beside a block of it: two codes of each value, or two pictures, and of each
// pixel its span, that again while the usual noise is sought, and a few regions.
[[nodiscard]] MemoryNeeds mask_making_needs(const CaptureFormat& capture);

// The mask has the size that everything stated agrees on. `capture` is null where no step reads one; `capture_name` is
// for messages; `plate` makes the capture's plate in codes of the capture, and is asked once where a step needs it.
// Throws UsageError where nothing tells a size, a step lacks its capture or plate, sizes differ or a time lies outside
// the capture, InputError where a picture has another size than the mask, or the capture is damaged.
[[nodiscard]] MadeMask make_mask(const MaskRequest& request, CaptureSource* capture,
                                 const std::string& capture_name, const std::function<Picture()>& plate = {});

// What a capture holds at a sample, in its codes. Throws InputError where the capture is damaged.
[[nodiscard]] Picture picture_of_sample(CaptureSource& source, std::uint64_t sample);

// Warns of steps that select no pixel, and of tags that later steps cover.
[[nodiscard]] std::vector<std::string> warnings_of(const MadeMask& made);

// What a mask's preview lies on: an exposure of an interval as a plain exposure's, of the picture at a start alone, or,
// with neither, of all of the capture.
[[nodiscard]] ExposedPicture backdrop_of(Session& session, const std::optional<StatedTime>& start,
                                         const std::optional<StatedTime>& length);

// Without a capture: the first picture that the mask was made from, else plain grey.
[[nodiscard]] Picture backdrop_of(const MaskRequest& request, const Mask& mask);

// A soft mask as files: a layer for each of its tags.
class MaskLayers {
 public:
  // `mask-%d.png`. Throws UsageError where the name has no place for a number.
  explicit MaskLayers(const std::filesystem::path& name);

  [[nodiscard]] std::filesystem::path file(std::uint64_t tag) const { return folder_ / numbered_.with(tag); }

  // Throws what check_output() does.
  void check(std::span<const std::string> inputs, Replacing replacing) const;

  // Writes those of the tags that have a share, in 16 bits. Throws OutputError, also where a layer of another mask is
  // there, which would be read along with them.
  void write(const Mask& mask) const;

 private:
  std::filesystem::path name_, folder_;
  NumberedName numbered_;
};

}  // namespace nutik
