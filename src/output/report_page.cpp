#include <cstddef>

#include "output/report.hpp"
// The sum of the page: compilers' caches know what is included, and nothing of what the assembler takes in.
#include EJECTA_REPORT_PAGE_SUM

// The file becomes part of the program as it is (a C array of it would take minutes to compile).
asm(".section .rodata\n"
    "ejecta_report_page_begin:\n"
    ".incbin \"" EJECTA_REPORT_PAGE
    "\"\n"
    "ejecta_report_page_end:\n"
    ".byte 0\n"
    ".previous\n");

extern const char page_begin[] asm("ejecta_report_page_begin");
extern const char page_end[] asm("ejecta_report_page_end");

namespace ejecta::output {

std::string_view report_page() { return {page_begin, static_cast<std::size_t>(page_end - page_begin)}; }

}  // namespace ejecta::output
