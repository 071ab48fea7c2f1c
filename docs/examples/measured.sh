# Makes curve.csv and the folder places, the measured curves of docs/experiment.md.
make="awk -f ${0%/*}/measured.awk"
asperity run jkr-sphere --set loading_stiffness=20 --set numerics.samples=150 --set "loading=[ToForce(5e-5), ToSeparation]" --format csv |
$make -v k=20 -v sigma=0.235 -v before=300 -v after=100 -v step=1e-8 -v offset=250 -v zero=2 -v drift=0.001 >curve.csv
mkdir places && for seed in 11 12 13 14 15 16; do
asperity run rough-sphere --set numerics.points=2048 --set loading_stiffness=200 --set numerics.samples=250 --set "loading=[ToForce(2e-4), ToSeparation]" --set roughness.seed=$seed --format csv |
$make -v k=200 -v sigma=2 -v before=150 -v after=60 -v step=2e-8 -v seed=$seed >places/$seed.csv
done
