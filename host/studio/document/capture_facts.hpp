// What the window knows of the capture that is open. Values: read once by the engine's threads, then only looked at.
#pragma once

#include <QImage>
#include <QPoint>
#include <QString>
#include <cstdint>
#include <vector>

#include "session/below/capture.hpp"

namespace nutik::studio {

// Of an opened capture: its shape, codes and times. timeline.rate() is its sample rate.
struct CaptureFacts {
  QString path;  // as the person gave it: a .tik or a clip
  CaptureFormat format;
  Timeline timeline;
  QString rate = {};  // pictures a second, as a person stated it; empty: what the clip says
};

// What the time strip shows behind the boxcar. Measured after the first picture, so that it does not delay it.
struct CaptureOverview {
  struct Thumbnail {
    std::int64_t time_ns = 0;
    QImage image;
  };
  std::vector<double> changed_share;  // of the pixels, by sample, 0 … 1; empty until it is measured
  std::vector<Thumbnail> thumbnails;  // in time order, evenly spaced
};

// The light of one pixel at each sample, drawn behind the curves.
struct Waveform {
  QPoint pixel;
  std::vector<double> light;  // by sample, mean of the channels, 1 is the capture's white
};

}  // namespace nutik::studio
