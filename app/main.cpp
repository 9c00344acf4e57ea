#include "app/commands.h"

int main(int argc, char** argv) { return aftershade::app::run_program(argc, argv); }
