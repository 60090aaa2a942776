use super::*;

/// The logarithms and their series for a small argument, on both sides of the place where one takes over.
#[test]
fn logarithms_join_their_series() {
    let layer = LayerCompliance { normal: 0.0, tangential: 1.0, stiffening: 0.4 };
    let joins = |ratio: &dyn Fn(f64) -> f64| {
        let [below, above] = [1.0 - 1e-12, 1.0 + 1e-12].map(|part| ratio(part * 1e-8 / layer.stiffening));
        assert!((above / below - 1.0).abs() < 1e-15, "{below:e} {above:e}");
    };
    joins(&|load| layer.extent(load) / load);
    joins(&|extent| layer.load_of_extent(extent) / extent);
}

#[test]
fn remainders_have_no_cancellation() {
    for k in -30..=3 {
        let x = 10f64.powi(k);
        // ∫ t/(1 + t x) dt, t from 0 to 1, is the remainder.
        let panels = |f: &dyn Fn(f64) -> f64| -> f64 {
            (0..256).map(|i| crate::numerics::quadrature::gauss(1.0 / 256.0, |t| f(f64::from(i) / 256.0 + t))).sum()
        };
        let exact = panels(&|t| t / (1.0 + t * x));
        assert!((logarithm_remainder(x) / exact - 1.0).abs() < 4e-15, "{x}");
    }
    for z in [0.0, 1e-9, 0.1, 0.3, 0.5_f64] {
        let exact = if z > 0.05 { (z.atanh() - z) / (z * z * z) } else { 1.0 / 3.0 + z * z / 5.0 };
        assert!((artanh_remainder(z) / exact - 1.0).abs() < 3e-14, "{z}");
    }
}
