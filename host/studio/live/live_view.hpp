// The picture of a document, exposed anew whenever it changes: LivePictures between two sides of the window.
//
//   in:      the document, and which pixels can be seen
//   out:     pictured(), on the window's thread: of several that came while the window was busy the newest alone
//   always:  the window never waits. While a drag lasts previews are asked for, of what is seen and may differ from
//            what is shown; otherwise the full picture follows, in the arithmetic that written pictures have
#pragma once

#include <QImage>
#include <QObject>
#include <QRect>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "session/live/live_pictures.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/session.hpp"
#include "studio/document/document.hpp"
#include "studio/live/changed_pixels.hpp"
#include "studio/live/jobs.hpp"

namespace nutik::studio {

// The open capture with fewer pixels, and what previews ask of it.

class ReducedCapture {
 public:
  // The session has one pixel for so many of the capture's to a side.
  ReducedCapture(std::shared_ptr<Session> session, int divisor);

  [[nodiscard]] int divisor() const { return divisor_; }
  // Whether a screen that shows a pixel of the capture with so many of its own to a side has less than two of them for
  // one of this. It is a preview.
  // Never with soft masks, whose edges are blended of the capture's pixels.
  [[nodiscard]] bool can_show(const ExposureRequest& exposure, double screen_pixels) const;
  // The same exposure; of the squares that these pixels of the capture lie in.
  [[nodiscard]] LivePart part(ExposureRequest exposure, const QRect& pixels);

 private:
  std::shared_ptr<Session> session_;
  int divisor_;
  SharedMask whole_, mask_;  // the last that was asked for, and as it is here
};

struct ShownPicture {
  QImage image;
  QRect place;  // in the capture's pixels; elsewhere what was shown still holds
  int divisor = 1;  // of a preview with fewer pixels: one for so many to a side
  bool is_full = false, is_of_all_seen = true;
  std::uint64_t pixels_below = 0, pixels_above = 0;  // saturated, of these
  QString arithmetic;                                // and its bound
  std::optional<double> codes_off;                   // at most, of 255; none: nobody knows, as of a preview
  double milliseconds = 0;                           // from the request to the picture
  QString warnings;
};

class LiveView : public QObject {
  Q_OBJECT

 public:
  LiveView(Document& document, Jobs& jobs, QObject* parent = nullptr);
  ~LiveView() override;

  // What pictures are exposed of; null: nothing. The session lives on until the next one.
  void show(std::shared_ptr<Session> session);
  // `screen_pixels`: how many of them a pixel of the capture has to a side.
  void set_visible(QRect pixels, double screen_pixels);
  // The same capture with fewer pixels, for previews that show no more of them; the finest first.
  void add_reduced(std::shared_ptr<Session> session, int divisor);
  [[nodiscard]] bool has_reduced() const { return !reduced_.empty(); }
  // The rest of a drag whose preview took longer has previews with up to four pixels of the screen for one of theirs.
  void set_prompt(double milliseconds) { prompt_ms_ = milliseconds; }
  // Whether a picture is on its way that nothing has delivered yet: for tests and for who wants to write it.
  [[nodiscard]] bool is_busy() const;
  // The document's mask as pictures are exposed with it; none while it is being feathered.
  [[nodiscard]] static Shared<MaskWithRegions> feathered_mask(const DocumentState& state);

 Q_SIGNALS:
  void pictured(const ShownPicture& picture);
  void failed(const QString& why);

 private:
  struct Soft {
    Shared<MaskWithRegions> hard;
    Feather feather;
    std::optional<Shared<MaskWithRegions>> mask;  // none while it is made
  };
  using Clock = std::chrono::steady_clock;

  void ask(bool with_full);
  [[nodiscard]] ReducedCapture* reduced_for(const ExposureRequest& exposure);  // null: the capture itself
  [[nodiscard]] QRect seen() const;
  [[nodiscard]] std::optional<Shared<MaskWithRegions>> mask_of(const DocumentState& state, bool& is_final);
  void deliver(LiveAnswer answer);
  void take();

  Document& document_;
  Jobs& jobs_;
  QRect visible_;
  double screen_pixels_ = 1, prompt_ms_ = 40;
  int least_divisor_ = 1;  // of this drag's previews
  std::optional<Soft> soft_;
  OutdatedPixels outdated_;
  std::uint64_t last_asked_ = 0, last_shown_ = 0, asked_before_drag_ = 0;
  bool full_wanted_ = false;
  bool full_shown_ = false;

  struct Delivered {
    std::uint64_t request;
    bool is_preview;
    ShownPicture picture;
    QString error;
  };
  std::mutex mutex_;  // guards what follows
  struct Asked {
    Clock::time_point at;
    int divisor;
  };
  std::map<std::uint64_t, Asked> requests_;
  std::optional<Delivered> delivered_;

  std::shared_ptr<Session> session_;
  std::vector<ReducedCapture> reduced_;
  std::unique_ptr<LivePictures> pictures_;  // last: it delivers into what is above
};

// What a document asks the engine for. `mask` stands in place of the document's: the same, feathered. command_line()
// (window/project_file.hpp) asks nutik-cl for the same exposure.
[[nodiscard]] ExposureRequest exposure_of(const DocumentState& state,
                                          const std::optional<Shared<MaskWithRegions>>& mask);

// The engine's picture as Qt draws it: from 8-bit codes, one channel or three, to Format_RGB32.
[[nodiscard]] QImage image_of(const Picture& picture);

// How pictures on the screen are stored: 8-bit sRGB.
[[nodiscard]] OutputFormat screen_format();

[[nodiscard]] QRect rectangle_of(const Rectangle& rectangle);
// The part of it that a picture of this shape has.
[[nodiscard]] Rectangle rectangle_of(const QRect& rectangle, const Shape& shape);

}  // namespace nutik::studio
