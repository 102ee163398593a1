// What a program does with memory that it has freed.
#pragma once

namespace nutik {

// Lets freed memory go back to the system soon, which is slower than keeping it for the next time. For programs that
// are to keep within little memory; holds for all of the process. Does nothing where the C library has no such choice.
void return_freed_memory();

}  // namespace nutik
