// Opens a capture or a clip, which is encoded into a temporary capture, as part of a job.
#pragma once

#include <QImage>
#include <QStringList>
#include <functional>
#include <memory>

#include "session/session.hpp"
#include "studio/document/capture_facts.hpp"
#include "studio/live/jobs.hpp"

namespace nutik::studio {

struct Opened {
  std::shared_ptr<Session> session;
  CaptureFacts facts;
  QStringList notes;  // what a person should know of the clip, whole sentences
};

// `rate`, pictures a second, is stated of a clip unless it is empty. `first_look` is told a clip's first picture, on the job's thread, before the clip is read whole. Throws what Session
// does.
[[nodiscard]] Opened open_capture(const QString& path, const QString& rate, std::shared_ptr<Devices> devices,
                                  const Job& job, const std::function<void(QImage)>& first_look);

}  // namespace nutik::studio
