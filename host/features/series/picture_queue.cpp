#include "features/series/picture_queue.hpp"

#include <utility>

#include "capture/error.hpp"

namespace nutik {

PictureQueue::PictureQueue(Failed failed)
    : writing_(std::async(std::launch::async, [this, failed = std::move(failed)] {
        const ClosedAtEnd closed(jobs_);  // nobody waits for a writer that is gone
        while (const auto job = jobs_.pop()) {
          try {
            write_picture(job->path, job->picture, job->text, job->wishes);
          } catch (const OutputError& error) {
            failed(job->number, error);
          } catch (const UsageError& error) {
            failed(job->number, error);
          }
        }
      })) {}

PictureQueue::~PictureQueue() { jobs_.close(); }

void PictureQueue::push(std::size_t number, std::filesystem::path path, Picture picture, std::string text,
                        const FileWishes& wishes) {
  Job job{number, std::move(path), std::move(picture), std::move(text), wishes};
  job.wishes.check = {};  // a picture that is made is kept
  if (!jobs_.push(std::move(job))) finish();
}

void PictureQueue::finish() {
  jobs_.close();
  writing_.get();
}

}  // namespace nutik
