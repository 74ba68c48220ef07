// Ctrl-C and SIGTERM as a question that a loop asks.
#pragma once

namespace lockstone::tool {

/// From now on SIGINT and SIGTERM no longer end the process.
void catch_interrupts();

/// True once one of them came.
[[nodiscard]] bool interrupted();

/// True once SIGTERM came alone, and once: a service that may take its time is asked to end.
[[nodiscard]] bool asked_to_end();

}  // namespace lockstone::tool
