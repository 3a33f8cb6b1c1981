# Prints what the Python tests skipped in their last run and why (conftest.py leaves one file for each
# test file that skipped any), because ctest hides the output of what passed. To read it:
# ctest -V -R python-skipped-tests
cmake_minimum_required(VERSION 3.20)
file(GLOB reports "${REPORTS}/*.txt")
foreach (report IN LISTS reports)
  get_filename_component(test "${report}" NAME_WE)
  if (NOT EXISTS "${TESTS}/${test}.py") # a test that is no more
    file(REMOVE "${report}")
    continue ()
  endif ()
  file(STRINGS "${report}" lines)
  foreach (line IN LISTS lines)
    message("skipped: ${line}")
  endforeach ()
endforeach ()
