#include "features/check/input_check.hpp"

#include <algorithm>
#include <cmath>

#include "capture/format.hpp"
#include "exposure/gain_function.hpp"
#include "render/delayed_course.hpp"
#include "session/text/number_text.hpp"

namespace nutik {
namespace {

using Severity = Finding::Severity;

// What is looked at where neither a capture nor a control point says how long it is.
constexpr std::int64_t kSomeDurationNs = 1'000'000'000;

constexpr std::size_t kExamples = 5;

// The first few of a list, as text.
template <typename Item, typename Text>
std::string examples_of(const std::vector<Item>& items, Text text) {
  std::string examples;
  for (std::size_t i = 0; i < std::min(items.size(), kExamples); ++i) {
    examples += (i == 0 ? "" : ", ") + text(items[i]);
  }
  return examples + (items.size() > kExamples ? ", …" : "");
}

Finding blended_finding(const std::string& mask_name, const std::vector<BlendedValue>& blended) {
  std::uint64_t pixels = 0;
  for (const BlendedValue& value : blended) pixels += value.pixel_count;
  const std::string examples = examples_of(blended, [](const BlendedValue& value) {
    return format("{} (first at {},{})", value.value, value.x, value.y);
  });
  return {Severity::warning,
          "blended_mask_values",
          mask_name,
          format("{} in between, on {} at edges: {}; edges were smoothed, or the mask was scaled or kept as "
                 "JPEG: paint it without smoothing and keep it as PGM or PNG",
                 counted(blended.size(), "value"), counted(pixels, "pixel"), examples),
          std::nullopt,
          {},
          blended};
}

Finding speck_finding(const std::string& mask_name, const std::vector<MaskSpeck>& specks) {
  const std::string examples = examples_of(specks, [](const MaskSpeck& speck) {
    return format("{},{} ({})", speck.x, speck.y, counted(speck.pixel_count, "pixel"));
  });
  return {Severity::warning,
          "mask_specks",
          mask_name,
          format("value {} has {} that may be slips of the brush: at {}", specks[0].tag,
                 counted(specks.size(), "speck"), examples),
          std::nullopt,
          {},
          specks};
}

}  // namespace

void InputCheck::add_functions(const std::string& name, std::string_view text) {
  functions_.emplace(CheckedFunctions{name, SourceText(text), parse_functions(text)});
  const Diagnostics& diagnostics = functions_->file.diagnostics;
  for (const Diagnostic& found : diagnostics.shown()) {
    add({found.severity, "function_file", name, found.message, found.place, found.excerpt});
  }
  for (const Severity severity : {Severity::error, Severity::warning}) {
    const std::size_t count = diagnostics.count(severity);
    if (count <= Diagnostics::kMaxShown) continue;
    add({severity, "function_file_more", name,
         format("and {} more {}", count - Diagnostics::kMaxShown,
                severity == Severity::error ? "mistakes" : "warnings")});
  }
}

void InputCheck::set_weight(const Normalization& normalization, double gain) {
  normalization_ = normalization;
  gain_ = gain;
}

void InputCheck::finish(bool unmapped_is_zero) {
  domain_ = domain_of_inputs();
  if (functions_) check_functions();
  if (mask_) check_mask(unmapped_is_zero);
  if (delay_) check_delay();
}

CheckedDomain InputCheck::domain_of_inputs() const {
  if (capture_ && capture_->timeline) return {capture_->timeline->duration_ns(), true};
  std::int64_t last_ns = 0;
  if (!functions_) return {last_ns, false};
  for (const auto& [tag, read] : functions_->file.functions) {
    last_ns = std::max(last_ns, read.function.points().back().time_ns);
  }
  return {last_ns > 0 ? last_ns : kSomeDurationNs, false};
}

Finding InputCheck::function_finding(std::string kind, std::uint8_t tag, std::size_t at,
                                     const std::string& message) const {
  return {Severity::warning,
          std::move(kind),
          functions_->name,
          format("M{}: {}", tag, message),
          functions_->source.place_of(at),
          functions_->source.excerpt(at),
          tag};
}

FunctionFigures InputCheck::figures_of(std::uint8_t tag, const GainSummary& summary) const {
  FunctionFigures figures{tag, summary, std::nullopt, std::nullopt};
  if (mask_) figures.pixels = mask_->pixels[tag];
  if (!mask_ && capture_ && functions_->file.functions.size() == 1) {
    figures.pixels = capture_->format.shape.pixel_count();  // a single function needs no mask
  }
  if (capture_ && capture_->timeline) {
    const Interval meant = meant_interval(functions_->file.functions.at(tag).function, summary);
    figures.samples =
        meant.empty() ? 0 : capture_->timeline->samples_reaching(meant.begin_ns, meant.end_ns).size();
  }
  return figures;
}

void InputCheck::check_functions() {
  std::vector<Finding> found;
  for (const auto& [tag, read] : functions_->file.functions) {
    const GainSummary written = summary_of(read.function);
    GainSummary summary = written;
    try {
      summary = summary_of(normalization_.normalized(read.function, domain_.duration_ns, gain_,
                                                     format("M{}", tag), delay_.has_value()));
    } catch (const InputError& error) {
      Finding finding = function_finding("not_normalizable", tag, read.start_at, error.what());
      finding.message = error.what();  // which starts with the mask value
      finding.severity = Severity::error;
      finding.settings = error.settings();
      found.push_back(std::move(finding));
    }
    std::vector<FunctionFinding> suspicious = check_function(read.function, summary, domain_);
    if (auto units = check_units(read.function, summary, domain_)) suspicious.push_back(std::move(*units));
    for (const FunctionFinding& finding : suspicious) {
      found.push_back(function_finding(std::string(to_text(finding.kind)), tag,
                                       finding.point ? read.time_at[*finding.point] : read.start_at,
                                       finding.message));
    }
    if (mask_ && mask_->pixels[tag] == 0) {
      found.push_back(function_finding("unused_function", tag, read.start_at,
                                       format("no pixel of {} has the value {}", mask_->name, tag)));
    }
    figures_.push_back(figures_of(tag, summary));
    figures_.back().integral_ns = std::scalbn(written.integral_ns, written.exponent);
  }
  std::ranges::stable_sort(found, {}, [](const Finding& finding) { return *finding.place; });
  std::ranges::move(found, std::back_inserter(findings_));
}

GainSummary InputCheck::summary_of(const GainFunction& function) const {
  return delay_ ? summarize_course(function, domain_.duration_ns) : summarize(function, domain_.duration_ns);
}

void InputCheck::check_delay() {
  const std::string name = delay_->file.empty() ? "delays" : delay_->file;
  if (!capture_) {
    add({Severity::warning, "delay_unchecked", name,
         format("without a capture it is not known which delays leave it{}; name one, too",
                mask_ ? "" : ", nor whether their map has its size")});
  }
  if (!capture_ && !mask_) return;
  const Shape shape = capture_ ? capture_->format.shape : Shape{mask_->mask.width, mask_->mask.height, 1};
  try {
    const auto delays = delays_of(*delay_, shape);
    if (!functions_ || functions_->file.functions.empty() || !capture_ || !capture_->timeline) return;
    FunctionSet functions;
    for (const auto& [tag, read] : functions_->file.functions) functions.emplace(tag, read.function);
    if (mask_ && !size_mistake(mask_->mask, shape).empty()) return;
    const auto map = MaskMap::of(
        mask_ ? mask_->mask : Mask::uniform(shape.width, shape.height, functions.begin()->first), delays);
    for (const std::string& warning : delay_warnings(*map, functions, capture_->timeline->duration_ns())) {
      add({Severity::warning, "delayed_outside", name, warning});
    }
  } catch (const InputError& error) {
    std::string message = error.what();
    if (message.starts_with(name + " ")) message.erase(0, name.size() + 1);
    add({Severity::error, "delay_map", name, message});
  }
}

void InputCheck::check_mask(bool unmapped_is_zero) {
  const auto& [name, mask, pixels] = *mask_;
  if (capture_) {
    const std::string mistake = size_mistake(mask, capture_->format.shape);
    if (!mistake.empty()) add({Severity::error, "mask_size", name, mistake});
  }
  std::array<bool, kMaskValues> is_mapped{};
  if (functions_) {
    for (const auto& [tag, read] : functions_->file.functions) is_mapped[tag] = true;
    for (const std::uint8_t tag : functions_->file.broken) is_mapped[tag] = true;
  }
  if (functions_ && !unmapped_is_zero) {
    const std::string mistake = unmapped_mistake(pixels, is_mapped);
    if (!mistake.empty()) {
      add({Severity::error, "unmapped_mask_values", name, mistake, {}, {}, {}, {Setting::unmapped}});
    }
  }
  // Layers are no painted values.
  const MaskFlaws flaws = mask.is_soft() ? MaskFlaws{} : find_flaws(mask, is_mapped);
  if (!flaws.blended.empty()) add(blended_finding(name, flaws.blended));
  for (auto first = flaws.specks.begin(); first != flaws.specks.end();) {
    const auto last = std::find_if(first, flaws.specks.end(),
                                   [&](const MaskSpeck& speck) { return speck.tag != first->tag; });
    add(speck_finding(name, {first, last}));
    first = last;
  }
}

}  // namespace nutik
