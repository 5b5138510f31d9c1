// Versions, and the message of the last failure in each thread.
#include "c/handles.h"

namespace {

thread_local std::string last_error;
/// Remains empty where there is no memory for a message.
thread_local const char* last_text = "";

}  // namespace

int lob_interface(void) { return LOB_INTERFACE; }

const char* lob_version(void) { return LOBELIA_VERSION; }

const char* lob_error(void) { return last_text; }

lob_status lobelia::c::fail(lob_status status, std::string message) noexcept {
    last_error = std::move(message);
    last_text = status == LOB_NO_MEMORY ? "out of memory" : last_error.c_str();
    return status;
}
