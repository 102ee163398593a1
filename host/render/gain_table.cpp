#include "render/gain_table.hpp"

#include <algorithm>

#include "exposure/weight_integrator.hpp"
#include "render/function_course.hpp"

namespace nutik {
namespace {

// The summary of a shifted function, whose divisor is the unshifted one's.
GainSummary supported(GainSummary summary, std::optional<std::int64_t> support_ns) {
  if (support_ns) summary.support_ns = *support_ns;
  return summary;
}

}  // namespace

std::uint64_t TableMemory::new_table() {
  const std::scoped_lock lock(mutex_);
  return tables_++;
}

std::shared_ptr<const TableRun> TableMemory::find(std::uint64_t table, std::size_t run) {
  const std::scoped_lock lock(mutex_);
  const auto place = places_.find({table, run});
  if (place == places_.end()) return nullptr;
  recent_.splice(recent_.begin(), recent_, place->second);
  return place->second->run;
}

void TableMemory::keep(std::uint64_t table, std::size_t run, std::shared_ptr<const TableRun> made) {
  const std::scoped_lock lock(mutex_);
  ++runs_made_;
  const std::pair key(table, run);
  if (places_.contains(key)) return;  // another thread made it meanwhile
  bytes_ += made->bytes();
  recent_.push_front({key, std::move(made)});
  places_.emplace(key, recent_.begin());
  while (bytes_ > max_bytes_) drop(std::prev(recent_.end()));
}

void TableMemory::forget(std::uint64_t table) {
  const std::scoped_lock lock(mutex_);
  for (auto place = places_.lower_bound({table, 0}); place != places_.end() && place->first.first == table;) {
    drop((place++)->second);
  }
}

void TableMemory::drop(std::list<Kept>::iterator kept) {
  bytes_ -= kept->run->bytes();
  places_.erase(kept->key);
  recent_.erase(kept);
}

std::uint64_t TableMemory::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

std::uint64_t TableMemory::runs_made() const {
  const std::scoped_lock lock(mutex_);
  return runs_made_;
}

SampleRange live_samples(const GainSummary& summary, const Timeline& timeline, bool live_all) {
  if (live_all) return {0, timeline.sample_count()};
  return timeline.samples_reaching(summary.live.begin_ns, summary.live.end_ns);
}

BlockTable TableRun::table(std::uint64_t block) const {
  const Block& at = blocks[block - first_block];
  if (at.span.empty()) return {at.span, {}, {}, at.before};
  const auto samples = static_cast<std::size_t>(at.span.last - at.span.first);
  const auto of_block = std::span(numbers).subspan(at.offset, 2 * samples + 1);
  return {at.span, of_block.first(samples), of_block.subspan(samples), at.before};
}

GainTable::GainTable(GainFunction function, bool live_all, std::shared_ptr<const CaptureLayout> layout,
                     std::shared_ptr<TableMemory> memory, std::optional<std::int64_t> support_ns)
    : function_(std::move(function)),
      live_all_(live_all),
      layout_(std::move(layout)),
      memory_(std::move(memory)),
      id_(memory_->new_table()),
      summary_(supported(summarize(function_, layout_->timeline.duration_ns()), support_ns)),
      findings_(check_domain(function_, summary_, {.duration_ns = layout_->timeline.duration_ns()})),
      live_(live_samples(summary_, layout_->timeline, live_all)),
      steady_(function_, summary_, live_, *layout_) {}

GainTable::~GainTable() { memory_->forget(id_); }

SampleSpan GainTable::span_in(const BlockExtent& block) const {
  const SampleRange samples = block.range();
  const std::uint64_t first = std::clamp(live_.first, samples.first, samples.last);
  const std::uint64_t last = std::clamp(live_.last, samples.first, samples.last);
  if (first >= last) return {};
  return {static_cast<std::uint16_t>(first - samples.first),
          static_cast<std::uint16_t>(last - samples.first)};
}

const FunctionCourse& GainTable::course() const {
  std::call_once(measured_, [this] { measure(); });
  return *course_;
}

const FunctionCourse& GainTable::parted_course() const {
  const FunctionCourse& whole = course();
  return parted_course_ ? *parted_course_ : whole;
}

void GainTable::measure() const {
  CourseMeter meter, parted;
  CompensatedSum sum;
  before_runs_.clear();
  for (std::size_t r = 0; r < layout_->run_count(); ++r) {
    before_runs_.push_back(sum);
    if (!touches(r)) continue;
    const auto made = make_run(r, sum);
    for (std::uint64_t block = layout_->run_starts[r]; block < layout_->run_starts[r + 1]; ++block) {
      const SteadyGain steady = steady_in(block);
      meter.add(made->table(block), steady);
      if (!has_corrected()) continue;
      if (steady.corrected.empty()) {
        parted.add(made->table(block), steady);
      } else {
        const HatNumbers hats = hats_of(layout_->blocks[block], layout_->timeline, steady.bundle.halves);
        parted.add_corrected(made->table(block), steady, hats);
      }
    }
    sum = made->after;
    memory_->keep(id_, r, made);
  }
  course_ = std::make_unique<FunctionCourse>(meter.course());
  if (has_corrected()) parted_course_ = std::make_unique<FunctionCourse>(parted.course());
  is_measured_ = true;
}

bool GainTable::touches(std::size_t run) const {
  const SampleRange samples = layout_->samples(run);
  return live_.first < samples.last && samples.first < live_.last;
}

std::shared_ptr<const TableRun> GainTable::run(std::size_t run) const {
  static_cast<void>(course());  // tells what comes before the run
  if (auto kept = memory_->find(id_, run)) return kept;
  auto made = make_run(run, before_runs_[run]);
  memory_->keep(id_, run, made);
  return made;
}

std::shared_ptr<const TableRun> GainTable::make_run(std::size_t run, CompensatedSum before) const {
  auto made = std::make_shared<TableRun>();
  made->first_block = layout_->run_starts[run];
  WeightIntegrator integrator(function_, summary_, layout_->timeline.duration_ns());
  for (std::uint64_t block = made->first_block; block < layout_->run_starts[run + 1]; ++block) {
    const BlockExtent& extent = layout_->blocks[block];
    const SampleSpan span = span_in(extent);
    const std::uint64_t offset = made->numbers.size();
    made->blocks.push_back({span, offset, before});
    if (span.empty()) continue;
    const std::vector<SampleTimes> times =
        layout_->timeline.times({extent.first_sample + span.first, extent.first_sample + span.last});
    made->numbers.resize(offset + 2 * times.size() + 1);
    const auto weights = std::span(made->numbers).subspan(offset, times.size());
    integrator.pack(times, weights, std::span(made->numbers).subspan(offset + times.size()));
    for (const double weight : weights) {
      if (weight != 0.0) before.add(weight);
    }
  }
  made->after = before;
  return made;
}

BlockTable GainTable::Reader::block(std::uint64_t block) {
  const std::size_t run = table_.layout_->run_of(block);
  if (!table_.touches(run)) return {};
  if (!run_ || run_->first_block != table_.layout_->run_starts[run]) run_ = table_.run(run);
  return run_->table(block);
}

}  // namespace nutik
