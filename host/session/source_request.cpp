#include "session/source_request.hpp"

namespace nutik {

bool SourceRequest::describes_clip() const {
  SourceRequest plain;
  plain.path = path;
  plain.clip.transfer = clip.transfer;  // what codes stand for can be stated of captures, too
  return *this != plain;
}

}  // namespace nutik
