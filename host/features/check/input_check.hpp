// Looks for mistakes in a function file, a mask and a capture, each optional, without exposing anything.
//
//   in:      what could be read of them
//   out:     findings, and figures for each function
//   always:  what could not be read is left out; the caller adds a finding for it
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "capture/fact.hpp"
#include "capture/source_text.hpp"
#include "capture/timeline.hpp"
#include "exposure/function_check.hpp"
#include "exposure/function_file.hpp"
#include "exposure/mask_check.hpp"
#include "exposure/normalization.hpp"
#include "render/render_plan.hpp"
#include "session/requests/delay_request.hpp"
#include "session/requests/exposure_request.hpp"

namespace nutik {

struct Finding {
  using Severity = Diagnostic::Severity;
  // A mask value; all values that an editor blended; all specks of one value.
  using Details =
      std::variant<std::monostate, std::uint8_t, std::vector<BlendedValue>, std::vector<MaskSpeck>>;

  Severity severity = Severity::error;
  std::string kind;                               // for scripts: `mistyped_time`
  std::string file;                               // the input it is about
  std::string message;                            // without the file's name
  std::optional<TextPlace> place = std::nullopt;  // in a function file
  Excerpt excerpt = {};
  Details details = {};
  std::vector<Setting> settings = {};  // that would help
  std::string advice = {};             // Error::advice()
};

// A function file and its text, which findings show.
struct CheckedFunctions {
  std::string name;
  SourceText source;
  FunctionFile file;
};

struct CheckedMask {
  std::string name;
  Mask mask;
  std::array<std::uint64_t, kMaskValues> pixels;  // of each value
};

struct CheckedCapture {
  std::string name;
  CaptureFormat format;
  std::optional<Timeline> timeline;  // not known for clips that do not say how long they are
  // What a clip is taken for, and what else a person should know.
  std::vector<Fact> facts = {};
  std::vector<Note> notes = {};
};

// What a function comes to.
struct FunctionFigures {
  std::uint8_t tag;
  GainSummary summary;  // normalized
  std::optional<std::uint64_t> pixels;
  std::optional<std::uint64_t> samples;
  double integral_ns = 0.0;  // as it is written
};

struct InputCheck {
  std::optional<CheckedFunctions> functions;  // add_functions() reads them
  std::optional<CheckedMask> mask;            // add_mask() counts its pixels
  std::optional<CheckedCapture> capture;
  std::optional<DelayRequest> delay;  // its picture, if it is one, has been read
  // What the figures are for.
  Normalization normalization;
  double gain = 1.0;

  CheckedDomain domain;
  std::vector<FunctionFigures> figures;  // by mask value
  std::vector<Finding> findings;

  // Finds the mistakes of its text.
  void add_functions(const std::string& name, std::string_view text);
  void add_mask(const std::string& name, Mask read) {
    const auto pixels = read.pixels_per_tag();
    mask.emplace(CheckedMask{name, std::move(read), pixels});
  }

  // Checks them against each other, once all have been added. Mask values without a function are no mistake if they are
  // exposed to black.
  void finish(bool unmapped_is_zero);

 private:
  [[nodiscard]] CheckedDomain domain_of_inputs() const;
  [[nodiscard]] Finding function_finding(std::string kind, std::uint8_t tag, std::size_t at,
                                         const std::string& message) const;
  [[nodiscard]] FunctionFigures figures_of(std::uint8_t tag, const GainSummary& summary) const;
  void check_functions();
  void check_mask(bool unmapped_is_zero);
  // Warns of functions that delays move outside of the capture.
  void check_delay();
  [[nodiscard]] GainSummary summary_of(const GainFunction& function) const;
};

}  // namespace nutik
