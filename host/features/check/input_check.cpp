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
  functions.emplace(CheckedFunctions{name, SourceText(text), parse_functions(text)});
  const Diagnostics& diagnostics = functions->file.diagnostics;
  for (const Diagnostic& found : diagnostics.shown()) {
    findings.push_back({found.severity, "function_file", name, found.message, found.place, found.excerpt});
  }
  for (const Severity severity : {Severity::error, Severity::warning}) {
    const std::size_t count = diagnostics.count(severity);
    if (count <= Diagnostics::kMaxShown) continue;
    findings.push_back({severity, "function_file_more", name,
         format("and {} more {}", count - Diagnostics::kMaxShown,
                severity == Severity::error ? "mistakes" : "warnings")});
  }
}

void InputCheck::finish(bool unmapped_is_zero) {
  domain = domain_of_inputs();
  if (functions) check_functions();
  if (mask) check_mask(unmapped_is_zero);
  if (delay) check_delay();
}

CheckedDomain InputCheck::domain_of_inputs() const {
  if (capture && capture->timeline) return {capture->timeline->duration_ns(), true};
  std::int64_t last_ns = 0;
  if (!functions) return {last_ns, false};
  for (const auto& [tag, read] : functions->file.functions) {
    last_ns = std::max(last_ns, read.function.points().back().time_ns);
  }
  return {last_ns > 0 ? last_ns : kSomeDurationNs, false};
}

Finding InputCheck::function_finding(std::string kind, std::uint8_t tag, std::size_t at,
                                     const std::string& message) const {
  return {Severity::warning,
          std::move(kind),
          functions->name,
          format("M{}: {}", tag, message),
          functions->source.place_of(at),
          functions->source.excerpt(at),
          tag};
}

FunctionFigures InputCheck::figures_of(std::uint8_t tag, const GainSummary& summary) const {
  FunctionFigures found{tag, summary, std::nullopt, std::nullopt};
  if (mask) found.pixels = mask->pixels[tag];
  if (!mask && capture && functions->file.functions.size() == 1) {
    found.pixels = capture->format.shape.pixel_count();  // a single function needs no mask
  }
  if (capture && capture->timeline) {
    const Interval meant = meant_interval(functions->file.functions.at(tag).function, summary);
    found.samples =
        meant.empty() ? 0 : capture->timeline->samples_reaching(meant.begin_ns, meant.end_ns).size();
  }
  return found;
}

void InputCheck::check_functions() {
  std::vector<Finding> found;
  for (const auto& [tag, read] : functions->file.functions) {
    const GainSummary written = summary_of(read.function);
    GainSummary summary = written;
    try {
      summary = summary_of(normalization.normalized(read.function, domain.duration_ns, gain,
                                                     format("M{}", tag), delay.has_value()));
    } catch (const InputError& error) {
      Finding finding = function_finding("not_normalizable", tag, read.start_at, error.what());
      finding.message = error.what();  // which starts with the mask value
      finding.severity = Severity::error;
      finding.settings = error.settings();
      found.push_back(std::move(finding));
    }
    std::vector<FunctionFinding> suspicious = check_function(read.function, summary, domain);
    if (auto units = check_units(read.function, summary, domain)) suspicious.push_back(std::move(*units));
    for (const FunctionFinding& finding : suspicious) {
      found.push_back(function_finding(std::string(to_text(finding.kind)), tag,
                                       finding.point ? read.time_at[*finding.point] : read.start_at,
                                       finding.message));
    }
    if (mask && mask->pixels[tag] == 0) {
      found.push_back(function_finding("unused_function", tag, read.start_at,
                                       format("no pixel of {} has the value {}", mask->name, tag)));
    }
    figures.push_back(figures_of(tag, summary));
    figures.back().integral_ns = std::scalbn(written.integral_ns, written.exponent);
  }
  std::ranges::stable_sort(found, {}, [](const Finding& finding) { return *finding.place; });
  std::ranges::move(found, std::back_inserter(findings));
}

GainSummary InputCheck::summary_of(const GainFunction& function) const {
  return delay ? summarize_course(function, domain.duration_ns) : summarize(function, domain.duration_ns);
}

void InputCheck::check_delay() {
  const std::string name = delay->file.empty() ? "delays" : delay->file;
  if (!capture) {
    findings.push_back({Severity::warning, "delay_unchecked", name,
         format("without a capture it is not known which delays leave it{}; name one, too",
                mask ? "" : ", nor whether their map has its size")});
  }
  if (!capture && !mask) return;
  const Shape shape = capture ? capture->format.shape : Shape{mask->mask.width, mask->mask.height, 1};
  try {
    const auto delays = delays_of(*delay, shape);
    if (!functions || functions->file.functions.empty() || !capture || !capture->timeline) return;
    FunctionSet delayed;
    for (const auto& [tag, read] : functions->file.functions) delayed.emplace(tag, read.function);
    if (mask && (mask->mask.width != shape.width || mask->mask.height != shape.height)) return;
    const auto map = MaskMap::of(
        mask ? mask->mask : Mask::uniform(shape.width, shape.height, delayed.begin()->first), delays);
    for (const std::string& warning : delay_warnings(*map, delayed, capture->timeline->duration_ns())) {
      findings.push_back({Severity::warning, "delayed_outside", name, warning});
    }
  } catch (const InputError& error) {
    std::string message = error.what();
    if (message.starts_with(name + " ")) message.erase(0, name.size() + 1);
    findings.push_back({Severity::error, "delay_map", name, message});
  }
}

void InputCheck::check_mask(bool unmapped_is_zero) {
  const auto& [name, tags, pixels] = *mask;
  try {
    if (capture) check_size(tags, capture->format);
  } catch (const InputError& mistake) {
    findings.push_back({Severity::error, "mask_size", name, mistake.what(), {}, {}, {}, {}, mistake.advice()});
  }
  std::array<bool, kMaskValues> is_mapped{};
  if (functions) {
    for (const auto& [tag, read] : functions->file.functions) is_mapped[tag] = true;
    for (const std::uint8_t tag : functions->file.broken) is_mapped[tag] = true;
  }
  if (functions && !unmapped_is_zero) {
    const std::string mistake = unmapped_mistake(pixels, is_mapped);
    if (!mistake.empty()) {
      findings.push_back({Severity::error, "unmapped_mask_values", name, mistake, {}, {}, {}, {Setting::unmapped}});
    }
  }
  // Layers are no painted values.
  const MaskFlaws flaws = tags.is_soft() ? MaskFlaws{} : find_flaws(tags, is_mapped);
  if (!flaws.blended.empty()) findings.push_back(blended_finding(name, flaws.blended));
  for (auto first = flaws.specks.begin(); first != flaws.specks.end();) {
    const auto last = std::find_if(first, flaws.specks.end(),
                                   [&](const MaskSpeck& speck) { return speck.tag != first->tag; });
    findings.push_back(speck_finding(name, {first, last}));
    first = last;
  }
}

}  // namespace nutik
