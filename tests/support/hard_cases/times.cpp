// Hard cases of time: control points and exposures where samples, gaps and the capture begin and end.
#include "support/hard_cases/parts.hpp"

namespace nutik::test {
namespace {

// Every kind of edge, and each of 5 ns round it: a step up, a step down, a pulse.
std::vector<GainFunction> steps_and_pulses(const std::vector<std::int64_t>& edges_ns) {
  std::vector<GainFunction> functions;
  for (const std::int64_t edge_ns : edges_ns) {
    for (std::int64_t time_ns = edge_ns - 2; time_ns <= edge_ns + 2; ++time_ns) {
      functions.emplace_back(std::vector<ControlPoint>{{time_ns, 0.0}, {time_ns + 1, 1.0}});
      functions.emplace_back(std::vector<ControlPoint>{{time_ns, 1.0}, {time_ns + 1, 0.0}});
      functions.push_back(pulse(time_ns));
    }
  }
  return functions;
}

HardCase nanosecond_steps_at_edges() {
  const Timeline timeline = Timeline::constant({30000, 1001}, kHalfShutter, 6);
  return noisy_case(format_of({11, 11, 1}, Transfer::srgb()), timeline,
                    steps_and_pulses({timeline.start_ns(0), timeline.end_ns(0), timeline.start_ns(1),
                                      timeline.end_ns(2), timeline.start_ns(3), timeline.start_ns(5),
                                      timeline.end_ns(5), timeline.duration_ns()}));
}

HardCase nanosecond_steps_without_gaps() {
  const Timeline timeline = Timeline::constant({960, 1}, Timeline::kFullShutter, 6);
  return noisy_case(format_of({8, 9, 1}, Transfer::linear(), 4095), timeline,
                    steps_and_pulses({timeline.start_ns(0), timeline.start_ns(1), timeline.start_ns(4),
                                      timeline.duration_ns()}));
}

// 28 hours in 100 samples.
HardCase nanosecond_steps_after_hours() {
  const Timeline timeline = Timeline::constant({1, 1000}, kHalfShutter, 100);
  const std::int64_t start_ns = timeline.start_ns(90);
  const std::int64_t gap_ns = timeline.end_ns(90);
  std::vector<GainFunction> functions = steps_and_pulses({start_ns, gap_ns});
  for (const std::int64_t time_ns : {start_ns - 1, gap_ns - 1}) {
    functions.emplace_back(std::vector<ControlPoint>{
        {time_ns, 0.0}, {time_ns + 1, 1.0}, {time_ns + 2, -1.0}, {time_ns + 3, 0.0}});
  }
  return noisy_case(format_of({9, 9, 1}, Transfer::linear(), 4095), timeline, std::move(functions));
}

HardCase exposures_within_a_gap() {
  const Timeline timeline = Timeline::constant({25, 1}, {1, 1}, 8);
  const std::int64_t begin_ns = timeline.end_ns(3);
  const std::int64_t end_ns = timeline.start_ns(4);
  const std::int64_t middle_ns = begin_ns + (end_ns - begin_ns) / 3;
  return noisy_case(
      format_of({8, 5, 1}, Transfer::srgb()), timeline,
      {GainFunction::boxcar(begin_ns, end_ns), GainFunction::boxcar(begin_ns + 1, end_ns - 1),
       GainFunction::boxcar(begin_ns - 1, end_ns + 1), GainFunction::boxcar(middle_ns, middle_ns + 1),
       GainFunction::boxcar(begin_ns, begin_ns + 1), GainFunction::boxcar(end_ns - 1, end_ns),
       GainFunction({{begin_ns, 0.0}, {end_ns, 1.0}, {end_ns + 1, 0.0}}),
       GainFunction({{begin_ns, 1.0}, {end_ns, -1.0}, {end_ns, 0.0}, {end_ns + 1, 0.0}})});
}

HardCase exposures_far_shorter_than_a_sample() {
  const Timeline timeline = Timeline::constant({25, 1}, Timeline::kFullShutter, 8);
  const std::int64_t inside_ns = timeline.start_ns(3) + 12'345'678;
  const std::int64_t edge_ns = timeline.start_ns(5);
  return noisy_case(
      format_of({8, 5, 3}, Transfer::bt709()), timeline,
      {GainFunction::boxcar(inside_ns, inside_ns + 1), GainFunction::boxcar(inside_ns, inside_ns + 7),
       GainFunction::boxcar(inside_ns, inside_ns + 1000), GainFunction::boxcar(edge_ns - 1, edge_ns + 1),
       GainFunction::boxcar(edge_ns - 1, edge_ns), GainFunction::boxcar(edge_ns, edge_ns + 1),
       GainFunction({{edge_ns - 10, 0.0}, {edge_ns - 1, 1.0}, {edge_ns + 4, -2.0}, {edge_ns + 5, 0.0}})});
}

HardCase irregular_timestamps() {
  Random random(7);
  std::vector<std::int64_t> starts_ns{-123'456'789};
  for (const std::int64_t longest_ns : {2ll, 10ll, 1000ll, 50'000'000ll, 20'000'000'000ll}) {
    for (int i = 0; i < 8; ++i) starts_ns.push_back(starts_ns.back() + random.whole(2, longest_ns));
  }
  const Timeline timeline = Timeline::irregular(starts_ns, {1728, 10});
  std::vector<GainFunction> functions{GainFunction::boxcar(0, timeline.duration_ns())};
  while (functions.size() < 20) functions.push_back(random_function(random, timeline));
  return noisy_case(format_of({9, 8, 1}, Transfer::bt709(), 65'535), timeline, std::move(functions));
}

// Some touch, some are a minute apart, some last 1 ns.
HardCase irregular_exposures() {
  Random random(8);
  std::vector<Exposure> exposures;
  std::int64_t time_ns = 0;
  for (int i = 0; i < 40; ++i) {
    const std::int64_t length_ns = i % 3 == 0 ? 1 : random.whole(1, 30'000'000);
    exposures.push_back({time_ns, time_ns + length_ns});
    time_ns += length_ns + (i % 4 == 0 ? 0 : i % 7 == 0 ? 60 * kSecondNs : random.whole(1, 20'000'000));
  }
  const Timeline timeline = Timeline::explicit_exposures(exposures);
  std::vector<GainFunction> functions{GainFunction::boxcar(0, timeline.duration_ns())};
  while (functions.size() < 20) functions.push_back(random_function(random, timeline));
  return noisy_case(format_of({9, 8, 1}, Transfer::srgb()), timeline, std::move(functions));
}

HardCase one_live_sample_among_a_million() {
  const Timeline timeline = Timeline::constant({1000, 1}, Timeline::kFullShutter, 1'000'000);
  const std::int64_t start_ns = timeline.start_ns(987'654);
  return noisy_case(
      format_of({5, 3, 1}, Transfer::srgb()), timeline,
      {GainFunction::boxcar(start_ns, start_ns + 1'000'000), GainFunction::boxcar(start_ns + 5, start_ns + 6),
       GainFunction(
           {{0, 0.0}, {start_ns, 0.0}, {start_ns + 1, 3.0}, {start_ns + 2, -2.0}, {start_ns + 3, 0.0}})});
}

HardCase nothing_is_live() {
  const Timeline timeline = Timeline::constant({25, 1}, kHalfShutter, 5);
  return noisy_case(format_of({9, 3, 1}, Transfer::srgb()), timeline,
                    {GainFunction({{0, 0.0}}), GainFunction::boxcar(kSecondNs, 2 * kSecondNs),
                     GainFunction({{-5, 2.0}, {-3, 0.0}})});
}

HardCase zero_beside_live_functions() {
  const Timeline timeline = Timeline::constant({25, 1}, kHalfShutter, 5);
  return noisy_case(
      format_of({9, 3, 1}, Transfer::srgb()), timeline,
      {GainFunction({{0, 0.0}}), GainFunction::boxcar(0, timeline.duration_ns()),
       GainFunction({{timeline.duration_ns(), 0.0}, {timeline.duration_ns() + 1, 4.0}}), pulse(60'000'000)});
}

HardCase functions_outside() {
  const Timeline timeline = Timeline::constant({25, 1}, kHalfShutter, 7);
  const std::int64_t end_ns = timeline.duration_ns();
  const std::int64_t far_ns = kLargestTimeNs;
  return noisy_case(
      format_of({8, 6, 1}, Transfer::srgb()), timeline,
      {GainFunction::boxcar(-kSecondNs, -1), GainFunction::boxcar(end_ns + 1, end_ns + kSecondNs),
       GainFunction::boxcar(-kSecondNs, 1), GainFunction::boxcar(end_ns - 1, end_ns + kSecondNs),
       GainFunction::boxcar(-kSecondNs, end_ns + kSecondNs), GainFunction({{-far_ns, -1.0}, {far_ns, 3.0}}),
       GainFunction({{-far_ns, 0.0}, {50'000'000, 2.0}, {50'000'001, -1.0}, {far_ns, 0.0}}),
       GainFunction({{-3, 5.0}, {4, -2.0}, {end_ns - 5, 1.0}, {end_ns + 6, -1.0}}),
       // 0 at the capture's start, from 126 years before it, and 1 at its end.
       GainFunction({{-far_ns, -static_cast<double>(far_ns)}, {end_ns, static_cast<double>(end_ns)}})});
}

constexpr NamedHardCase kTimeCases[] = {
    {"NanosecondStepsAtEdges", "steps of 1 ns on and round the edges of samples, gaps and the capture",
     nanosecond_steps_at_edges},
    {"NanosecondStepsWithoutGaps", "the same where one sample's end is the next one's start",
     nanosecond_steps_without_gaps},
    {"NanosecondStepsAfterHours",
     "1 ns after 25 hours is 1 in 10^14: differences of integrals from the start lose it",
     nanosecond_steps_after_hours},
    {"ExposuresWithinAGap", "no sample was exposed while the gain was not 0: everything is ramps",
     exposures_within_a_gap},
    {"ExposuresFarShorterThanASample", "1 ns of 40 ms: weights of nearly all samples are 0, D is tiny",
     exposures_far_shorter_than_a_sample},
    {"IrregularTimestamps", "periods from 2 ns to 20 s in one capture", irregular_timestamps},
    {"IrregularExposures", "exposures of 1 ns to 30 ms that touch or lie a minute apart",
     irregular_exposures},
    {"OneLiveSampleAmongAMillion", "times and sample numbers are large, what is read is one block",
     one_live_sample_among_a_million},
    {"NothingIsLive", "D = 0 for every function: no block, no division by 0", nothing_is_live},
    {"ZeroBesideLiveFunctions", "D = 0 for some functions of a picture", zero_beside_live_functions},
    {"FunctionsOutside", "functions partly and wholly outside the capture, control points 126 years away",
     functions_outside},
};

}  // namespace

std::span<const NamedHardCase> hard_times() { return kTimeCases; }

}  // namespace nutik::test
