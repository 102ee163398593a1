// Where one shot turns into another over several pictures: a dissolve, or a fade through black or white.
//
//   in:      each picture's means of cells, as shares of white
//   out:     the pictures that show something of both
//   always:  both ends differ in most cells and in their fine structure, and most cells of either are neither black nor
//            white. What lies between is their sum, with less and less of the first and more and more of the second.
//            Hence no flash, no lamp, no exposure that drifts, no pan or zoom, nothing that moves. Of a dissolve a
//            tenth of the cells may move; one between pictures that move more is not told from those
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "capture/picture.hpp"
#include "imev/sample_cursor.hpp"

namespace nutik {

class DissolveFinder {
 public:
  // Pictures have so many cells, a channel beside the other.
  explicit DissolveFinder(const Shape& cells) : cells_(cells) {}

  void add(const std::vector<float>& means);
  // In order, apart from each other.
  [[nodiscard]] const std::vector<SampleRange>& found() const { return found_; }

 private:
  // A picture without its mean, and what is left of that without the mean of each cell's neighbours.
  struct Layer {
    std::vector<float> values;
    double square = 0;
  };
  struct Look {
    std::vector<float> means;
    Layer coarse, fine;
    bool is_exposed = false;  // most cells are neither black nor white
  };

  void test(std::size_t first);

  Shape cells_;
  std::deque<Look> looks_;  // at the last pictures
  std::uint64_t count_ = 0;
  std::vector<SampleRange> found_;
};

}  // namespace nutik
