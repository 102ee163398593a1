// What a search for gains is asked, of a scene of one pixel.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "solve/gain_search.hpp"

namespace nutik::test {

// Light of one grey pixel, in shares of white, 10 ms a sample.
class OnePixel {
 public:
  explicit OnePixel(const std::vector<double>& light)
      : timeline_(Timeline::constant({100, 1}, Timeline::kFullShutter, light.size())) {
    std::vector<ChannelLight> course;
    for (const double each : light) course.push_back({each, 0.0, 0.0});
    wished.regions.resize(1);
    wished.regions[0].courses.emplace(std::uint8_t{0}, LightCourse(timeline_, 0, std::move(course)));
    wished.duration_ns = timeline_.duration_ns();
    wished.luminance = {1.0, 0.0, 0.0};
  }

  void set(const char* functions) {
    FunctionTemplate read = parse_template(functions);
    ASSERT_FALSE(read.has_errors()) << read.diagnostics.report("");
    wished.functions = read.functions;
    wished.bounds.resize(read.gains.size());
  }
  void wish(LightWish::Kind kind, double light, double weight = 1.0) {
    LightWish wish;
    wish.kind = kind;
    wish.target = light;
    wish.weight = weight;
    wished.wishes.push_back(wish);
  }

  WishedExposure wished;

 private:
  Timeline timeline_;
};

}  // namespace nutik::test
