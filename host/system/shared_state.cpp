#include "system/shared_state.hpp"

namespace nutik {
namespace {

SharedState own;
std::atomic<SharedState*> used{&own};

}  // namespace

SharedState& shared_state() { return *used.load(std::memory_order_relaxed); }

void use_shared_state(SharedState& of_program) { used = &of_program; }

}  // namespace nutik
