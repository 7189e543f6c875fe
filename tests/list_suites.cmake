# Writes OUT, in which ctest reads the suites of PROGRAM as tests NAME.<Suite>, with LABEL where one is given, or else the label
# "all" where the name of the suite begins with Long; those that match PACED take two processors. Run by CMake after each build
# of the program.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE said RESULT_VARIABLE status TIMEOUT 60)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} could not list its tests: ${status}")
endif()
string(REGEX MATCHALL "\n[^ \n][^ \n]*\\." suites "\n${said}")  # tests are indented; after a suite may come "  # TypeParam"
set(text)
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "^\n|\\.$" "" suite "${suite}")
  set(properties TIMEOUT 1800)
  if(PACED AND suite MATCHES "${PACED}")
    list(APPEND properties PROCESSORS 2)
  endif()
  if(LABEL)
    list(APPEND properties LABELS ${LABEL})
  elseif(suite MATCHES "^(.*/)?Long")
    list(APPEND properties LABELS all)
  endif()
  list(JOIN properties " " properties)
  string(APPEND text "add_test([==[${NAME}.${suite}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==])\n"
    "set_tests_properties([==[${NAME}.${suite}]==] PROPERTIES ${properties})\n")
endforeach()
if(NOT text)
  message(FATAL_ERROR "${PROGRAM} has no tests")
endif()
file(WRITE ${OUT} "${text}")
