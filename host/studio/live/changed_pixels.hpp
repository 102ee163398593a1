// Where pictures differ whose exposures differ in little.
#pragma once

#include <QRect>
#include <map>
#include <optional>

#include "session/requests/exposure_request.hpp"
#include "system/shared.hpp"

namespace nutik::studio {

using SharedMask = std::optional<Shared<MaskWithRegions>>;

// The least rectangle that holds all pixels whose tags differ. Everything where one of the masks is soft or missing.
[[nodiscard]] QRect changed_pixels(const SharedMask& before, const SharedMask& now, const QRect& everything);

// The least rectangle round each tag's pixels, of the mask that was asked for last.
class TagBoxes {
 public:
  // Everything where the mask is soft or missing.
  [[nodiscard]] QRect of(const SharedMask& mask, std::uint8_t tag, const QRect& everything);

 private:
  SharedMask mask_;
  std::map<std::uint8_t, QRect> boxes_;
};

// Which pixels of the picture that is shown differ, or may differ, from what was asked for last.
class OutdatedPixels {
 public:
  // Those of a request that are seen, of a picture with one pixel for `divisor` to a side; a single one where there are
  // none.
  // `is_shown`: the request before was answered, and shown.
  [[nodiscard]] QRect to_expose(const ExposureRequest& request, const QRect& seen, int divisor, bool is_shown);
  // All of them.
  void forget() { last_.reset(); }

 private:
  struct Last {
    ExposureRequest request;
    QRect seen;
    int divisor;
  };
  [[nodiscard]] QRect since_last(const ExposureRequest& request, const QRect& seen, int divisor);

  std::optional<Last> last_;
  QRect outdated_;
  TagBoxes boxes_;
};

}  // namespace nutik::studio
