#include "commands.h"

int main(int argc, char** argv) {
  return tendril::runner::run_program(argc, argv);
}
