# The full numbers of the property test of energy and of the pairs that collide.
add_test(NAME dem_energy_10000 COMMAND test_dem --gtest_filter=Energy.*)
set_tests_properties(dem_energy_10000 PROPERTIES LABELS "slow;dem" ENVIRONMENT EJECTA_ENERGY_SCENES=10000 TIMEOUT 36000)
add_test(NAME dem_restitution_all COMMAND test_dem --gtest_filter=Restitution.*)
set_tests_properties(dem_restitution_all PROPERTIES LABELS "slow;dem" ENVIRONMENT EJECTA_ALL_PAIRS=1 TIMEOUT 7200)
