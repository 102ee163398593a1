#include "tik/checksum.hpp"

#include <new>

namespace nutik::tik {

Checksum::Checksum() : state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_64bits_reset(state_.get());
}

}  // namespace nutik::tik
