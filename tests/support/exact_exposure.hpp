// What a picture is, in exact rational arithmetic: Σ_k v_k ∫ g φ_k / D for the values asked for, and of mixed pixels
// the shares of that.
//
//   in:      a plan (its functions and which pixel has which; none of its tables), the timeline, and the
//            codes that each sample holds; plan and timeline must live longer
//   cost:    a function's weights are made when the first value asks for them, and then kept
//   exact:   everything but the light of a code, which is the transfer function's in double, as it is
//            for the reference
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "render/render_plan.hpp"
#include "support/exact.hpp"
#include "support/hard_cases.hpp"
#include "support/random_case.hpp"

namespace nutik::test {

class ExactExposure {
 public:
  ExactExposure(const RenderPlan& plan, const Timeline& timeline, DrawSample sample);

  // Value i of the picture; 0 where D is 0.
  [[nodiscard]] Exact light(std::uint64_t i) const;
  [[nodiscard]] const ExactSummary& summary(std::size_t function) const {
    return function_at(function).summary;
  }
  // S of value i's function, or its shares of them.
  [[nodiscard]] Exact scale(std::uint64_t i) const;

 private:
  struct Function {
    ExactSummary summary;
    std::vector<std::pair<std::uint64_t, Exact>> weights_ns;  // by sample; those that are not 0
  };

  [[nodiscard]] const Function& function_at(std::size_t index) const;
  [[nodiscard]] Exact light(const Function& function, std::uint64_t i) const;
  // Σ share · of(function) over the functions of value i.
  template <typename Of>
  [[nodiscard]] Exact mixed(std::uint64_t i, Of of) const;

  const RenderPlan& plan_;
  const Timeline& timeline_;
  DrawSample sample_;
  mutable std::map<std::size_t, Function> functions_;
  mutable std::map<std::uint64_t, std::vector<std::byte>> rasters_;  // of the samples that some weight needs
};

// Values of a picture to compare: all of them where there are at most `most`, else some of every function
// and as many more, drawn with `seed`. Of more functions than `kMaxComparedFunctions` only those that are drawn.
constexpr std::size_t kMaxComparedFunctions = 256;
[[nodiscard]] std::vector<std::uint64_t> values_to_compare(const RenderPlan& plan, std::size_t most,
                                                           std::uint64_t seed);

// The largest error of a case's picture of light64, in u of S; each of these values is to be within `most`.
[[nodiscard]] double worst_roundings(const RenderPlan& plan, const RandomCase& random, const Picture& picture,
                                     std::uint64_t seed, double most);

}  // namespace nutik::test
