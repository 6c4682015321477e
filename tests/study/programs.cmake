# The stated errors of maps against the truth, on all random margins.
add_test(NAME study_coverage_100 COMMAND test_study --gtest_filter=OutlineCoverage.*)
set_tests_properties(study_coverage_100 PROPERTIES LABELS "slow;study" ENVIRONMENT EJECTA_MARGINS=100 TIMEOUT 3600)
