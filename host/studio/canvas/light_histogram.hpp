// Light before codes end it at black and white: how much there is of each brightness, and which pixels no code shows.
#pragma once

#include <QImage>
#include <QWidget>
#include <array>
#include <cstdint>
#include <map>
#include <memory>

#include "render/output_format.hpp"
#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/jobs.hpp"

namespace nutik::studio {

struct MeasuredLight {
  // A screen's codes, and above white sixteenths of a stop.
  static constexpr int kCodes = 256, kStops = 3, kPartsOfStop = 16, kBins = kCodes + kStops * kPartsOfStop;
  using Counts = std::array<std::uint32_t, kBins>;

  std::vector<Counts> channels;  // of all pixels
  std::map<std::uint8_t, Counts> regions;  // of each pixel's brightest channel, by tag
  std::map<std::uint8_t, Saturation> saturated;
  QImage marks;  // red beyond white, blue below 0; elsewhere nothing
};
// The light of the picture that the document's state exposes.
[[nodiscard]] MeasuredLight measured_light(Session& session, const DocumentState& state, const Job& job);

// Channels as areas, the selected region as a line.
class LightHistogram : public QWidget {
  Q_OBJECT

 public:
  explicit LightHistogram(Document& document, QWidget* parent = nullptr);

  void show_light(std::shared_ptr<const MeasuredLight> light);

 protected:
  void paintEvent(QPaintEvent* event) override;
  QSize sizeHint() const override { return {240, 72}; }

 private:
  [[nodiscard]] QPolygonF outline(const MeasuredLight::Counts& counts) const;

  Document& document_;
  std::shared_ptr<const MeasuredLight> light_;
};

}  // namespace nutik::studio
