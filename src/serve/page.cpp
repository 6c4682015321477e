#include <cstddef>

#include "serve/server.hpp"
// The sum of the page, for compilers' caches: see output/report_page.cpp.
#include EJECTA_WORKBENCH_PAGE_SUM

// The file becomes part of the program as it is, as that of the report does.
asm(".section .rodata\n"
    "ejecta_workbench_page_begin:\n"
    ".incbin \"" EJECTA_WORKBENCH_PAGE
    "\"\n"
    "ejecta_workbench_page_end:\n"
    ".byte 0\n"
    ".previous\n");

extern const char workbench_begin[] asm("ejecta_workbench_page_begin");
extern const char workbench_end[] asm("ejecta_workbench_page_end");

namespace ejecta {

std::string_view workbench_page() {
  return {workbench_begin, static_cast<std::size_t>(workbench_end - workbench_begin)};
}

}  // namespace ejecta
