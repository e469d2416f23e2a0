"""Strain energies in GetFEM's language, in space and in the section of a body of revolution."""

# A case does not have what a material alone has: it is that of MaterialConfig() (src/cell/material/material.h).
OGDEN_EXPONENT, GENT_LIMIT = 4, 30


def strain_energy(law, young, poisson, dimension, mixed):
    """Returns the energy density, weighted for the section; None for a law that is not here.

    mixed: p g - p^2 / (2 lambda) replaces the dilatational part lambda/2 g^2, p a variable.
    """
    mu, lam = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    section = dimension == 2
    gradient = f'(Id({dimension})+Grad_u)'
    hoop = '(1+u(1)/X(1))'  # stretch about the axis
    jacobian = f'(Det{gradient}*{hoop})' if section else f'Det{gradient}'
    first = f'(Norm_sqr{gradient}+sqr{hoop})' if section else f'Norm_sqr{gradient}'
    if law in ('linear', 'st_venant_kirchhoff'):
        if law == 'linear':
            strain, around = 'Sym(Grad_u)', '(u(1)/X(1))'
        else:
            strain, around = f"(0.5*({gradient}'*{gradient}-Id({dimension})))", f'(0.5*(sqr{hoop}-1))'
        distortion = f'{mu!r}*(Norm_sqr({strain})' + (f'+sqr{around})' if section else ')')
        dilatation = f'(Trace({strain})' + (f'+{around})' if section else ')')
    elif law == 'neo_hookean':
        dilatation = f'log({jacobian})'
        distortion = f'{mu / 2!r}*({first}-3)-{mu!r}*{dilatation}'
    elif law == 'ogden':  # of exponent 4, for which the sum of powers is tr C^2
        dilatation = f'log({jacobian})'
        fourth = f"(Norm_sqr({gradient}'*{gradient})" + (f'+pow({hoop},4))' if section else ')')
        distortion = f'{2 * mu / OGDEN_EXPONENT ** 2!r}*({fourth}-3)-{2 * mu / OGDEN_EXPONENT!r}*{dilatation}'
    elif law == 'gent':
        lam -= 2 * mu / GENT_LIMIT
        dilatation = f'log({jacobian})'
        distortion = f'{-mu * GENT_LIMIT / 2!r}*log(1-({first}-3)/{GENT_LIMIT})-{mu!r}*{dilatation}'
    elif law == 'stable_neo_hookean':
        m, lam = 4 * mu / 3, lam + 5 * mu / 6
        dilatation = f'({jacobian}-1)'
        distortion = f'{m / 2!r}*({first}-3-log(({first}+1)/4))-{0.75 * m!r}*{dilatation}'
    elif law == 'neo_hookean_isochoric':  # mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2: that of CalculiX
        dilatation = f'({jacobian}-1)'
        distortion = f'{mu / 2!r}*({first}*pow({jacobian},-2/3)-3)'
        lam += 2 * mu / 3
    else:
        return None
    volume = f'p*{dilatation}-sqr(p)/{2 * lam!r}' if mixed else f'{lam / 2!r}*sqr({dilatation})'
    return f'({distortion}+{volume})' + ('*(2*pi*X(1))' if section else '')
