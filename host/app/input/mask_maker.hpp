// Makes a mask from its steps.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/input/mask_steps.hpp"
#include "exposure/mask.hpp"
#include "imev/capture_source.hpp"

namespace nutik::app {

// What a step came to.
struct StepReport {
  std::string option;
  std::uint8_t tag = 0;                   // of a grid, the first
  std::uint8_t last_tag = 0;              // of a grid; else the same
  std::uint64_t pixel_count = 0;          // that it gave its tag
  std::optional<std::uint32_t> by_codes;  // more than which a code had to change
};

class MaskMaker {
 public:
  // Begins with `base`. `capture` is null where no step reads one; both outlive the maker.
  MaskMaker(Mask base, CaptureSource* capture) : mask_(std::move(base)), capture_(capture) {}

  // Throws UsageError where a time lies outside the capture, InputError where a picture cannot be read or has
  // another size than the mask, or the capture is damaged.
  void add(const MaskStep& step);

  [[nodiscard]] const Mask& mask() const { return mask_; }
  [[nodiscard]] const std::vector<StepReport>& reports() const { return reports_; }

 private:
  [[nodiscard]] Region region_of(const MaskStep& step, StepReport& report);
  [[nodiscard]] Region moving(SampleRange samples, const MaskStep& step, StepReport& report);
  [[nodiscard]] Region changed(const std::vector<std::uint32_t>& spans, std::uint32_t white_code,
                               const MaskStep& step, StepReport& report) const;
  [[nodiscard]] Picture picture_at(const PictureOrTime& word, const MaskStep& step);

  Mask mask_;
  CaptureSource* capture_;
  std::vector<StepReport> reports_;
  // Of samples that a step has looked at: the capture is read once for steps with the same times.
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<std::uint32_t>> spans_;
};

// A picture file, codes as they stand. Throws InputError where it cannot be read, UsageError where it is a
// sequence.
[[nodiscard]] Picture read_picture(const std::string& name);

// What a capture holds at a sample.
[[nodiscard]] Picture picture_of_sample(CaptureSource& source, std::uint64_t sample);

}  // namespace nutik::app
