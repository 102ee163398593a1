// A session: one capture, and the devices that expose pictures of it.
//
//   in:      requests, which are values
//   out:     pictures and what is to be said of them, as values. Nothing is printed
//   threads: any number may ask one session. Requests that share a device take turns at it. A session that is moved or
//            destroyed is asked by nobody
//   files:   a .tik that is made shorter while it is open ends the program (SIGBUS), but after watch_mapped_files()
//
// A .tik is read where it lies. A clip is read in one of two ways, and that says what can be asked:
//
//   whole     encoded into a temporary capture before the session is there. Anything, as often as one likes; blocks
//             stay on the device, as far as memory allows, for the next picture
//   forward   read while the picture is exposed, no further than that needs. One render(), even a failed one; anything
//             else throws SessionIsSpent. A .tik read forward is not kept on the device
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "align/alignment.hpp"
#include "opencl/validation.hpp"
#include "render/trace.hpp"
#include "session/clips/source_check.hpp"
#include "session/devices.hpp"
#include "session/exposed_picture.hpp"
#include "session/requests/exposure_request.hpp"
#include "session/requests/source_request.hpp"
#include "system/interruption.hpp"
#include "tik/reader.hpp"

namespace nutik {

enum class Reading { whole, forward };

// A session of one picture was asked for more.
struct SessionIsSpent : UsageError {
  SessionIsSpent();
};

// Which pixels are followed: one, or all of a mask value.
struct TracedPixel {
  std::uint32_t x = 0, y = 0;
};
struct TracedTag {
  std::uint8_t tag = 0;
};
using Followed = std::variant<TracedPixel, TracedTag>;

struct TracedExposure {
  std::vector<Trace> traces;  // one for each function: of a mixed pixel there are several
  ExposureFigures figures;
  std::vector<std::string> warnings;

  [[nodiscard]] const PlannedFunction& function_of(const Trace& trace) const {
    return figures.functions[trace.function];
  }
};

struct ValidatedExposure {
  Validation validation;
  ExposureFigures figures;
  std::vector<std::string> warnings;
};

class Session {
 public:
  // How a session is opened.
  struct Terms {
    Reading reading = Reading::whole;
    ReportedProgress progress = {};  // of a clip that is read whole, in samples
    std::stop_token stop = {};       // ends that: Cancelled

    // Makes the clip, in place of the one at the source's path, which is its name in messages. Such a
    // clip is read whole; UsageError where the source states what only files have.
    OpenClip open_clip = {};

    // The part of the budget that the caller uses beside the session: for pictures that wait to be written, say.
    NeedsOfFormat besides = {};
    bool renders = true;  // false: the capture will only be read
  };

  // Throws UsageError where the request describes a clip and names a .tik, or does not fit the clip; InputError where
  // the capture cannot be read; OutputError where there is no space for a temporary one; MemoryTooLittle.
  Session(const SourceRequest& source, std::shared_ptr<Devices> devices, const Terms& terms);
  Session(const SourceRequest& source, std::shared_ptr<Devices> devices);
  // With devices of its own.
  explicit Session(const SourceRequest& source, const ComputingRequest& computing = {});
  ~Session();
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;

  [[nodiscard]] const SourceRequest& source() const;
  [[nodiscard]] Devices& devices() const;
  // Whether it was made from a clip.
  [[nodiscard]] bool is_clip() const;
  [[nodiscard]] const CaptureFormat& format() const;
  // For a clip that is read forward, as its files announce it: a picture brings the true one.
  [[nodiscard]] const Timeline& timeline() const;
  // What a clip is taken for, each with who said it: its times first. None of a .tik, whose header has them.
  [[nodiscard]] const std::vector<Fact>& facts() const;
  // Whether both pixels that shared a sample of chroma have its values, as clips of 8 bits are read.
  [[nodiscard]] bool repeats_chroma() const;
  // Where a clip's sound lies beside its pictures; none where it has none.
  [[nodiscard]] const std::optional<ClipSound>& sound() const;
  // On a clip: what a person should know, and what is doubtful about the capture made from it. Whole sentences.
  [[nodiscard]] const std::vector<Note>& notes() const;
  [[nodiscard]] const std::vector<std::string>& warnings() const;

  // Exposes a picture, all of it or a rectangle. Throws UsageError where the request does not fit the capture,
  // InputError where mask and functions do not or a block is damaged, DeviceError where the device fails, Cancelled.
  [[nodiscard]] ExposedPicture render(const ExposureRequest& request, const OutputFormat& output,
                                      const RenderControl& control = {});

  // The same of functions as they are, whatever the timeline; of a whole session.
  [[nodiscard]] ExposedPicture render(const FunctionSet& functions, const Mask& mask,
                                      const PlanOptions& options, const OutputFormat& output,
                                      const RenderControl& control = {});

  // Hands pictures one after another to done(number, exposed), each as soon as it is there. Those of few
  // pixels, each with one function and in the arithmetic that is chosen by itself, are made many at once, in one pass
  // over the capture and in double (render/one_pass.hpp). Throws as render() does.
  using RenderedOne = std::function<void(std::size_t number, ExposedPicture exposed)>;
  void render_many(std::span<const ExposureRequest> requests, const OutputFormat& output, const RenderControl& control,
                   const RenderedOne& done);

  // How the light of a pixel came about, or of the mean of all pixels of a mask value.
  [[nodiscard]] TracedExposure trace(const ExposureRequest& request, const Followed& followed,
                                     const ReportedProgress& progress = {});

  // Every arithmetic of the OpenCL device against the reference.
  [[nodiscard]] ValidatedExposure validate(const ExposureRequest& request, const OutputFormat& output,
                                           std::uint32_t runs, const ReportedProgress& progress = {});

  // The capture beside the clip it was made from.
  [[nodiscard]] SourceCheck compare_with(const SourceRequest& clip, const ReportedProgress& progress = {});

  // How many finished pictures of a type may wait to be written.
  [[nodiscard]] std::uint32_t waiting_pictures(ValueType type) const;

  // How many of so many pictures of a type are best asked for at the same time, each with RenderControl::by_one_device.
  // 1: one after another, and without that.
  [[nodiscard]] std::size_t pictures_at_once(ValueType type, std::size_t count) const;

  // The capture itself, to read its blocks. Of a session that was read whole.
  [[nodiscard]] tik::Reader& capture();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace nutik
