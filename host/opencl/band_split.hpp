// How the rows of pictures are shared out among devices: a band for each, in proportion to what it does in a time.
//
//   in:      how fast the devices seem, then how long each took for its band
//   out:     bands from top to bottom, cut where tiles end, so that no tile is read twice
//   always:  the bands are the rectangle, each row once. They stay where they are until waiting has cost as much as
//            moving them would: what a band reads stays on its device, and is read again elsewhere
#pragma once

#include <span>
#include <vector>

#include "capture/picture.hpp"

namespace nutik {

class BandSplit {
 public:
  // Speeds of any unit, above 0.
  explicit BandSplit(std::span<const double> speeds);

  // By device. One without rows has none to do: pictures may have fewer rows of tiles than there are devices.
  [[nodiscard]] std::vector<Rectangle> cut(const Rectangle& rectangle) const;

  // What they took for bands that cut() returned, all at the same time.
  void took(std::span<const Rectangle> bands, std::span<const double> seconds);

  // By device; they add up to 1.
  [[nodiscard]] std::span<const double> shares() const { return shares_; }

 private:
  // What a device did in the last pictures since the bands moved.
  struct Done {
    double pixels = 0.0;
    double seconds = 0.0;
  };
  void forget();

  std::vector<double> shares_;
  std::vector<Done> done_;
  double longest_ = 0.0;  // of these pictures, in seconds
};

}  // namespace nutik
