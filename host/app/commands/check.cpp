#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "app/commands/commands.hpp"
#include "app/input/capture_input.hpp"
#include "app/input/standard_input.hpp"
#include "app/output/console.hpp"
#include "app/output/json.hpp"
#include "app/text/findings.hpp"
#include "app/text/size_text.hpp"
#include "app/text/text_table.hpp"
#include "app/text/time_text.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "exposure/function_check.hpp"
#include "exposure/function_file.hpp"
#include "exposure/mask.hpp"
#include "exposure/mask_check.hpp"

namespace nutik::app {
namespace {

using Severity = Finding::Severity;

// What is looked at where neither a capture nor a control point says how long it is.
constexpr std::int64_t kSomeDurationNs = 1'000'000'000;

// A function file and its text, which findings show.
struct ReadFunctions {
  std::string name;
  SourceText source;
  FunctionFile file;

  [[nodiscard]] Finding finding(Severity severity, std::string kind, std::uint8_t tag, std::size_t at,
                                const std::string& message) const {
    return {severity,
            std::move(kind),
            name,
            format("M{}: {}", tag, message),
            source.place_of(at),
            source.excerpt(at),
            Json{{"mask_value", tag}}};
  }
};

struct ReadMask {
  std::string name;
  Mask mask;
  std::array<std::uint64_t, kMaskValues> pixels;
};

struct OpenCapture {
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
    if (functions_) check_functions();
    if (mask_) check_mask();
  }

  void print_text() const {
    const std::string text = findings_.text();
    if (!options_.quiet) print_line(heading());
    if (!text.empty()) print_line(text);
    if (options_.quiet) return;
    if (!figures_.empty()) print_line(table());
    print_line(findings_.verdict());
  }

  [[nodiscard]] Json json() const;
  [[nodiscard]] bool has_mistakes() const { return findings_.count(Severity::error) > 0; }

 private:
  // An input that cannot be read is a finding like others: the rest is checked all the same.
  template <typename Read>
  void attempt(const std::string& name, const std::string& kind, Read read) {
    try {
      read();
    } catch (const InputError& error) {
      std::string message = error.what();
      // Findings start with the file's name anyway.
      for (const char* behind : {": ", " "}) {
        if (message.starts_with(name + behind)) message.erase(0, message.find(' ', name.size()) + 1);
      }
      findings_.add({Severity::error, kind, name, message});
    }
  }

  void read_functions() {
    const std::string name = input_title(*options_.functions);
    const InputBytes input(*options_.functions);
    const std::string_view text = input.text();
    functions_.emplace(ReadFunctions{name, SourceText(text), parse_functions(text)});
    const Diagnostics& diagnostics = functions_->file.diagnostics;
    for (const Diagnostic& found : diagnostics.shown()) {
      findings_.add({found.severity, "function_file", name, found.message, found.place, found.excerpt});
    }
    for (const Severity severity : {Severity::error, Severity::warning}) {
      const std::size_t count = diagnostics.count(severity);
      if (count <= Diagnostics::kMostShown) continue;
      findings_.add({severity, "function_file_more", name,
                     format("and {} more {}", count - Diagnostics::kMostShown,
                            severity == Severity::error ? "mistakes" : "warnings")});
    }
  }

  void open_mask() {
    Mask mask = read_mask_input(*options_.mask);
    const auto pixels = mask.pixels_per_tag();
    mask_.emplace(ReadMask{input_title(*options_.mask), std::move(mask), pixels});
  }

  void open_capture(const std::string& name) {
    if (!is_tik(name)) {
      const SourceOptions source_options = SourceOptions::from(options_);
      const SourceClip source = open_source(name, source_options);
      const ClipInfo info = source.clip->info();
      capture_.emplace(OpenCapture{name, source.capture, std::nullopt});
      if (info.sample_count == 0) return;
      capture_->timeline =
          timeline_of(name, info, source_options.clip, source_options.shutter_angle, info.sample_count);
      return;
    }
    refuse_source_options(options_, name);
    tik::Reader reader(name);
    capture_.emplace(OpenCapture{name, reader.format(), reader.timeline()});
    for (std::uint64_t block = 0; block < reader.block_count(); ++block) {
      attempt(name, "capture_block", [&] { reader.prepare(block); });
    }
  }

  void set_domain() {
    if (capture_ && capture_->timeline) {
      domain_ = {capture_->timeline->duration_ns(), true};
      return;
    }
    domain_ = {0, false};
    if (!functions_) return;
    for (const auto& [tag, read] : functions_->file.functions) {
      domain_.duration_ns = std::max(domain_.duration_ns, read.function.points().back().time_ns);
    }
    if (domain_.duration_ns <= 0) domain_.duration_ns = kSomeDurationNs;
  }

  void check_functions() {
    std::vector<Finding> found;
    for (const auto& [tag, read] : functions_->file.functions) {
      const GainSummary summary = summarize(read.function, domain_.duration_ns);
      for (const FunctionFinding& finding : check_function(read.function, summary, domain_)) {
        found.push_back(functions_->finding(Severity::warning, std::string(to_text(finding.kind)), tag,
                                            finding.point ? read.time_at[*finding.point] : read.start_at,
                                            finding.message));
      }
      if (mask_ && mask_->pixels[tag] == 0) {
        found.push_back(functions_->finding(Severity::warning, "unused_function", tag, read.start_at,
                                            format("no pixel of {} has the value {}", mask_->name, tag)));
      }
      FunctionFigures figures{tag, summary, std::nullopt, std::nullopt};
      if (mask_) figures.pixels = mask_->pixels[tag];
      if (!mask_ && capture_ && functions_->file.functions.size() == 1) {
        figures.pixels = capture_->format.shape.pixel_count();  // a single function needs no mask
      }
      if (capture_ && capture_->timeline) {
        const Interval& live = summary.live;
        figures.samples =
            live.empty() ? 0 : capture_->timeline->samples_reaching(live.begin_ns, live.end_ns).size();
      }
      figures_.push_back(figures);
    }
    std::ranges::stable_sort(found, {}, [](const Finding& finding) { return *finding.place; });
    for (Finding& finding : found) findings_.add(std::move(finding));
  }

  void check_mask() {
    if (capture_) {
      if (const std::string mistake = size_mistake(mask_->mask, capture_->format.shape); !mistake.empty()) {
        findings_.add({Severity::error, "mask_size", mask_->name, mistake});
      }
    }
    std::array<bool, kMaskValues> is_mapped{};
    if (functions_) {
      for (const auto& [tag, read] : functions_->file.functions) is_mapped[tag] = true;
      for (const std::uint8_t tag : functions_->file.broken) is_mapped[tag] = true;
    }
    if (functions_ && !options_.unmapped) {
      if (const std::string mistake = unmapped_mistake(mask_->pixels, is_mapped); !mistake.empty()) {
        findings_.add({Severity::error, "unmapped_mask_values", mask_->name, mistake});
      }
    }
    const MaskFlaws flaws = find_flaws(mask_->mask, is_mapped);
    if (!flaws.blended.empty()) add_blended(flaws.blended);
    for (auto first = flaws.specks.begin(); first != flaws.specks.end();) {
      const auto last = std::find_if(first, flaws.specks.end(),
                                     [&](const MaskSpeck& speck) { return speck.tag != first->tag; });
      add_specks({first, last});
      first = last;
    }
  }

  void add_blended(const std::vector<BlendedValue>& blended) {
    std::uint64_t pixels = 0;
    std::string examples;
    Json values = Json::array();
    for (std::size_t i = 0; i < blended.size(); ++i) {
      const BlendedValue& value = blended[i];
      pixels += value.pixel_count;
      values.push_back(
          {{"mask_value", value.value}, {"pixels", value.pixel_count}, {"x", value.x}, {"y", value.y}});
      if (i >= kExamples) continue;
      examples += format("{}{} (first at {},{})", i == 0 ? "" : ", ", value.value, value.x, value.y);
    }
    findings_.add(
        {Severity::warning,
         "blended_mask_values",
         mask_->name,
         format("{} value{} in between, on {} pixels at edges: {}{}; edges were smoothed, or the mask was "
                "scaled or kept as JPEG: paint it without smoothing and keep it as PGM or PNG",
                blended.size(), blended.size() == 1 ? "" : "s", pixels, examples,
                blended.size() > kExamples ? ", …" : ""),
         std::nullopt,
         {},
         Json{{"values", values}}});
  }

  void add_specks(const std::vector<MaskSpeck>& specks) {
    std::string examples;
    Json places = Json::array();
    for (std::size_t i = 0; i < specks.size(); ++i) {
      const MaskSpeck& speck = specks[i];
      places.push_back({{"x", speck.x}, {"y", speck.y}, {"pixels", speck.pixel_count}});
      if (i >= kExamples) continue;
      examples += format("{}{},{} ({} pixel{})", i == 0 ? "" : ", ", speck.x, speck.y, speck.pixel_count,
                         speck.pixel_count == 1 ? "" : "s");
    }
    findings_.add({Severity::warning,
                   "mask_specks",
                   mask_->name,
                   format("value {} has {} speck{} that may be slips of the brush: at {}{}", specks[0].tag,
                          specks.size(), specks.size() == 1 ? "" : "s", examples,
                          specks.size() > kExamples ? ", …" : ""),
                   std::nullopt,
                   {},
                   Json{{"mask_value", specks[0].tag}, {"specks", places}}});
  }

  [[nodiscard]] std::string heading() const {
    std::string text;
    const auto append = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
    if (functions_) {
      const std::size_t count = functions_->file.functions.size() + functions_->file.broken.size();
      append(format("{}: {} function{}", functions_->name, count, count == 1 ? "" : "s"));
    }
    if (mask_) append(format("{}: {} x {}", mask_->name, mask_->mask.width, mask_->mask.height));
    if (capture_ && capture_->timeline) {
      append(format("{}: {}, {} samples, {}", capture_->name, shape_text(capture_->format.shape),
                    capture_->timeline->sample_count(), duration_text(domain_.duration_ns)));
    } else if (capture_) {
      append(format("{}: {}, its length is not known before it is decoded", capture_->name,
                    shape_text(capture_->format.shape)));
    }
    if (functions_ && !domain_.is_capture) {
      append(format("figures are for 0 … {}, not for a capture",
                    integral_text(static_cast<double>(domain_.duration_ns))));
    }
    return text.empty() ? "nothing could be read" : text;
  }

  // Without columns of what is not known.
  [[nodiscard]] std::string table() const {
    const auto is_known = [&](auto member) {
      return std::ranges::any_of(figures_,
                                 [&](const auto& figures) { return (figures.*member).has_value(); });
    };
    const bool has_pixels = is_known(&FunctionFigures::pixels);
    const bool has_samples = is_known(&FunctionFigures::samples);
    const auto count = [](const std::optional<std::uint64_t>& number) {
      return number ? format("{}", *number) : std::string("-");
    };
    const auto time = [](std::int64_t ns) { return integral_text(static_cast<double>(ns)); };
    std::vector<std::vector<std::string>> rows;
    const auto add_row = [&](const std::string& function, const std::string& pixels,
                             std::vector<std::string> figures, const std::string& samples) {
      std::vector<std::string> row{function};
      if (has_pixels) row.push_back(pixels);
      std::ranges::move(figures, std::back_inserter(row));
      if (has_samples) row.push_back(samples);
      rows.push_back(std::move(row));
    };
    add_row("function", "pixels", {"live", "D", "∫g", "still gain", "stops"}, "samples");
    for (const FunctionFigures& figures : figures_) {
      const GainSummary& summary = figures.summary;
      const Interval& live = summary.live;
      add_row(format("M{}", figures.tag), count(figures.pixels),
              {live.empty() ? "never" : time(live.begin_ns) + " … " + time(live.end_ns),
               time(summary.support_ns), integral_text(std::scalbn(summary.integral_ns, summary.exponent)),
               format("{:.6g}", summary.still_gain()), stops_text(summary)},
              count(figures.samples));
    }
    return table_text(rows, std::string("l") + (has_pixels ? "r" : "") + "lrrrr" + (has_samples ? "r" : ""));
  }

  [[nodiscard]] static std::string stops_text(const GainSummary& summary) {
    const auto stops = still_stops(summary);
    if (!stops) return "-";
    const double shown = std::round(*stops * 100) / 100;
    return shown == 0.0 ? "0" : format("{:+.2f}", shown);
  }

  static constexpr std::size_t kExamples = 5;

  const Options& options_;
  Findings findings_;
  std::optional<ReadFunctions> functions_;
  std::optional<ReadMask> mask_;
  std::optional<OpenCapture> capture_;
  CheckedDomain domain_;
  std::vector<FunctionFigures> figures_;
};

Json Checking::json() const {
  Json functions = Json::array();
  for (const FunctionFigures& figures : figures_) {
    const GainSummary& summary = figures.summary;
    const auto stops = still_stops(summary);
    Json function{{"mask_value", figures.tag},
                  {"pixels", figures.pixels ? Json(*figures.pixels) : Json()},
                  {"live_start_ns", summary.live.begin_ns},
                  {"live_end_ns", summary.live.end_ns},
                  {"nonzero_ns", summary.support_ns},
                  {"integral_ns", std::scalbn(summary.integral_ns, summary.exponent)},
                  {"still_gain", summary.still_gain()},
                  {"stops", stops ? Json(*stops) : Json()},
                  {"samples", figures.samples ? Json(*figures.samples) : Json()}};
    functions.push_back(std::move(function));
  }
  return Json{{"mistakes", findings_.count(Severity::error)},
              {"warnings", findings_.count(Severity::warning)},
              {"findings", findings_.json()},
              {"domain_end_ns", domain_.duration_ns},
              {"domain_is_capture", domain_.is_capture},
              {"functions", functions}};
}

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
