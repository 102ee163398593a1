// What a check looked at, and what it came to.
//
//   in:      function file, mask and capture as far as they could be read
//   out:     findings and figures, as text and as JSON
//   always:  what could not be read is left out; a finding tells of it
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/output/json.hpp"
#include "app/text/findings.hpp"
#include "session/capture.hpp"
#include "session/functions.hpp"

namespace nutik::app {

// A function file and its text, which findings show.
struct CheckedFunctions {
  std::string name;
  SourceText source;
  FunctionFile file;

  // One on a function, at a byte of the file.
  [[nodiscard]] Finding finding(Finding::Severity severity, std::string kind, std::uint8_t tag,
                                std::size_t at, const std::string& message) const;
};

struct CheckedMask {
  std::string name;
  Mask mask;
  std::array<std::uint64_t, kMaskValues> pixels;
};

struct CheckedCapture {
  std::string name;
  CaptureFormat format;
  std::optional<Timeline> timeline;  // not known for clips that do not say how long they are
};

// What a function comes to.
struct FunctionFigures {
  std::uint8_t tag;
  GainSummary summary;
  std::optional<std::uint64_t> pixels;
  std::optional<std::uint64_t> samples;
};

struct CheckedInputs {
  std::optional<CheckedFunctions> functions;
  std::optional<CheckedMask> mask;
  std::optional<CheckedCapture> capture;
  CheckedDomain domain;
  std::vector<FunctionFigures> figures;  // by mask value
  Findings findings;
};

// A warning of all values that an editor blended, or of all specks of one value.
[[nodiscard]] Finding blended_finding(const std::string& mask_name, const std::vector<BlendedValue>& blended);
[[nodiscard]] Finding speck_finding(const std::string& mask_name, const std::vector<MaskSpeck>& specks);

// A line on what was looked at.
[[nodiscard]] std::string heading_text(const CheckedInputs& checked);
// A row for each function, without columns of what is not known. For at least one function.
[[nodiscard]] std::string figures_text(const CheckedInputs& checked);

[[nodiscard]] Json check_json(const CheckedInputs& checked);

}  // namespace nutik::app
