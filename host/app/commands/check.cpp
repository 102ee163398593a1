#include <algorithm>
#include <array>

#include "app/commands/commands.hpp"
#include "app/input/standard_input.hpp"
#include "app/output/console.hpp"
#include "app/requests/source_words.hpp"
#include "app/text/check_text.hpp"
#include "app/text/message_text.hpp"
#include "session/capture.hpp"
#include "session/clip_source.hpp"
#include "session/error.hpp"
#include "session/format.hpp"
#include "session/functions.hpp"

namespace nutik::app {
namespace {

using Severity = Finding::Severity;

// What is looked at where neither a capture nor a control point says how long it is.
constexpr std::int64_t kSomeDurationNs = 1'000'000'000;

class Checking {
 public:
  explicit Checking(const Options& options) : options_(options) {}

  void run() {
    if (options_.functions)
      attempt(input_title(*options_.functions), "function_file", [&] { read_functions(); });
    if (options_.mask) attempt(input_title(*options_.mask), "mask_file", [&] { open_mask(); });
    if (!options_.operands.empty()) {
      attempt(options_.operands.front(), "capture", [&] { open_capture(options_.operands.front()); });
    }
    set_domain();
    if (checked_.functions) check_functions();
    if (checked_.mask) check_mask();
  }

  void print_text() const {
    const std::string text = checked_.findings.text();
    if (!options_.quiet) print_line(heading_text(checked_));
    if (!text.empty()) print_line(text);
    if (options_.quiet) return;
    if (!checked_.figures.empty()) print_line(figures_text(checked_));
    print_line(checked_.findings.verdict());
  }

  [[nodiscard]] Json json() const { return check_json(checked_); }
  [[nodiscard]] bool has_mistakes() const { return checked_.findings.count(Severity::error) > 0; }

 private:
  // An input that cannot be read is a finding like others: the rest is checked all the same.
  template <typename Read>
  void attempt(const std::string& name, const std::string& kind, Read read) {
    try {
      read();
    } catch (const InputError& error) {
      std::string message = message_text(error);
      // Findings start with the file's name anyway.
      for (const char* behind : {": ", " "}) {
        if (message.starts_with(name + behind)) message.erase(0, message.find(' ', name.size()) + 1);
      }
      checked_.findings.add({Severity::error, kind, name, message});
    }
  }

  void read_functions() {
    const std::string name = input_title(*options_.functions);
    const InputBytes input(*options_.functions);
    const std::string_view text = input.text();
    checked_.functions.emplace(CheckedFunctions{name, SourceText(text), parse_functions(text)});
    const Diagnostics& diagnostics = checked_.functions->file.diagnostics;
    for (const Diagnostic& found : diagnostics.shown()) {
      checked_.findings.add(
          {found.severity, "function_file", name, found.message, found.place, found.excerpt});
    }
    for (const Severity severity : {Severity::error, Severity::warning}) {
      const std::size_t count = diagnostics.count(severity);
      if (count <= Diagnostics::kMostShown) continue;
      checked_.findings.add({severity, "function_file_more", name,
                             format("and {} more {}", count - Diagnostics::kMostShown,
                                    severity == Severity::error ? "mistakes" : "warnings")});
    }
  }

  void open_mask() {
    Mask mask = read_mask_input(*options_.mask);
    const auto pixels = mask.pixels_per_tag();
    checked_.mask.emplace(CheckedMask{input_title(*options_.mask), std::move(mask), pixels});
  }

  void open_capture(const std::string& name) {
    const SourceRequest request = source_request(options_, name);
    if (!is_tik(name)) {
      const ClipSource source = open_clip_source(request, memory_budget(options_));
      checked_.capture.emplace(CheckedCapture{name, source.capture, std::nullopt});
      if (source.announced_samples() == 0) return;
      checked_.capture->timeline = source.timeline(source.announced_samples());
      return;
    }
    tik::Reader reader(name);
    checked_.capture.emplace(CheckedCapture{name, reader.format(), reader.timeline()});
    for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
      attempt(name, "capture_block", [&] { reader.check(block); });
    }
  }

  void set_domain() {
    if (checked_.capture && checked_.capture->timeline) {
      checked_.domain = {checked_.capture->timeline->duration_ns(), true};
      return;
    }
    checked_.domain = {0, false};
    if (!checked_.functions) return;
    for (const auto& [tag, read] : checked_.functions->file.functions) {
      checked_.domain.duration_ns =
          std::max(checked_.domain.duration_ns, read.function.points().back().time_ns);
    }
    if (checked_.domain.duration_ns <= 0) checked_.domain.duration_ns = kSomeDurationNs;
  }

  void check_functions() {
    std::vector<Finding> found;
    for (const auto& [tag, read] : checked_.functions->file.functions) {
      const GainSummary summary = summarize(read.function, checked_.domain.duration_ns);
      for (const FunctionFinding& finding : check_function(read.function, summary, checked_.domain)) {
        found.push_back(checked_.functions->finding(
            Severity::warning, std::string(to_text(finding.kind)), tag,
            finding.point ? read.time_at[*finding.point] : read.start_at, finding.message));
      }
      if (checked_.mask && checked_.mask->pixels[tag] == 0) {
        found.push_back(
            checked_.functions->finding(Severity::warning, "unused_function", tag, read.start_at,
                                        format("no pixel of {} has the value {}", checked_.mask->name, tag)));
      }
      FunctionFigures figures{tag, summary, std::nullopt, std::nullopt};
      if (checked_.mask) figures.pixels = checked_.mask->pixels[tag];
      if (!checked_.mask && checked_.capture && checked_.functions->file.functions.size() == 1) {
        figures.pixels = checked_.capture->format.shape.pixel_count();  // a single function needs no mask
      }
      if (checked_.capture && checked_.capture->timeline) {
        const Interval& live = summary.live;
        figures.samples =
            live.empty() ? 0
                         : checked_.capture->timeline->samples_reaching(live.begin_ns, live.end_ns).size();
      }
      checked_.figures.push_back(figures);
    }
    std::ranges::stable_sort(found, {}, [](const Finding& finding) { return *finding.place; });
    for (Finding& finding : found) checked_.findings.add(std::move(finding));
  }

  void check_mask() {
    if (checked_.capture) {
      if (const std::string mistake = size_mistake(checked_.mask->mask, checked_.capture->format.shape);
          !mistake.empty()) {
        checked_.findings.add({Severity::error, "mask_size", checked_.mask->name, mistake});
      }
    }
    std::array<bool, kMaskValues> is_mapped{};
    if (checked_.functions) {
      for (const auto& [tag, read] : checked_.functions->file.functions) is_mapped[tag] = true;
      for (const std::uint8_t tag : checked_.functions->file.broken) is_mapped[tag] = true;
    }
    if (checked_.functions && !options_.unmapped) {
      if (const std::string mistake = unmapped_mistake(checked_.mask->pixels, is_mapped); !mistake.empty()) {
        checked_.findings.add({Severity::error, "unmapped_mask_values", checked_.mask->name, mistake});
      }
    }
    const MaskFlaws flaws = find_flaws(checked_.mask->mask, is_mapped);
    if (!flaws.blended.empty()) checked_.findings.add(blended_finding(checked_.mask->name, flaws.blended));
    for (auto first = flaws.specks.begin(); first != flaws.specks.end();) {
      const auto last = std::find_if(first, flaws.specks.end(),
                                     [&](const MaskSpeck& speck) { return speck.tag != first->tag; });
      checked_.findings.add(speck_finding(checked_.mask->name, {first, last}));
      first = last;
    }
  }

  const Options& options_;
  CheckedInputs checked_;
};

}  // namespace

int run_check(const Options& options) {
  if (options.operands.size() > 1) {
    throw UsageError(format("'{}' is one file too many: check looks at one capture", options.operands[1]));
  }
  if (options.operands.empty() && !options.functions && !options.mask) {
    throw UsageError(
        "what should be checked? nutik-cl check -m mask.pgm -k functions.fn clip.tik, each optional");
  }
  if (options.unmapped && *options.unmapped != "zero") {
    throw UsageError(
        format("--unmapped {} is not known; the only choice is --unmapped zero", *options.unmapped));
  }
  Checking checking(options);
  checking.run();
  if (options.json) {
    print_json(checking.json());
  } else {
    checking.print_text();
  }
  return checking.has_mistakes() ? 3 : 0;
}

}  // namespace nutik::app
