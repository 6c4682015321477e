#include "app/cli/commands.hpp"

int main(int argc, char** argv) { return ejecta::run_command_line(argc, argv); }
